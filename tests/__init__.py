"""Tests of Deck: unit (no ROS), ros (real rclpy), tui (pilot, snapshots), e2e (a terminal)."""
