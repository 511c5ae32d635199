"""Tests of `robot` that need no ROS and no terminal."""
