"""Tests of `nodes` with real ROS and real processes."""
