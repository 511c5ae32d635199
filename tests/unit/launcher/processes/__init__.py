"""Tests of `launcher.processes` that need no ROS and no terminal."""
