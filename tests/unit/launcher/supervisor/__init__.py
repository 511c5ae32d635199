"""Tests of `launcher.supervisor` that need no ROS and no terminal."""
