"""Tests of `launcher.profile` that need no ROS and no terminal."""
