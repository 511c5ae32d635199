"""Tests of `launcher.logs` that need no ROS and no terminal."""
