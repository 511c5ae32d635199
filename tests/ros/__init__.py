"""Tests over real rclpy and real processes."""
