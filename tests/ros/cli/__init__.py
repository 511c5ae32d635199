"""Tests of `cli` with real ROS and real processes."""
