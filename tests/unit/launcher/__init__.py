"""Tests of `launcher` that need no ROS and no terminal."""
