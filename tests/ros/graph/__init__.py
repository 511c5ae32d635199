"""Tests of `graph` with real ROS and real processes."""
