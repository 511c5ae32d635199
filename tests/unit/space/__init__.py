"""Tests of `space` that need no ROS and no terminal."""
