"""Tests of `robot` with real ROS and real processes."""
