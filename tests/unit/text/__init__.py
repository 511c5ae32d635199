"""Tests of `text` that need no ROS and no terminal."""
