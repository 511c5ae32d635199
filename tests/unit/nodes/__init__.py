"""Tests of `nodes` that need no ROS and no terminal."""
