"""Tests of the packages of ROS that PyPI does not have."""
