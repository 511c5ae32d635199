"""Tests of Deck: unit (no ROS), ros (real rclpy and processes), tui (pilot, snapshots), e2e (a terminal)."""
