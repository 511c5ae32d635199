"""Tests of `cli` that need no ROS and no terminal."""
