"""Tests of what agents may do, without ROS."""
