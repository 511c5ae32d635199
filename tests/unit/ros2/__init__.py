"""Tests of the command `ros2` that need no ROS."""
