"""Tests of `tui` that need no ROS and no terminal."""
