"""Tests of `launcher` with real ROS and real processes."""
