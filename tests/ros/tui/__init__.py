"""Tests of `tui` with real ROS and real processes."""
