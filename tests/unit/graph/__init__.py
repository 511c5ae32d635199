"""Tests of `graph` that need no ROS and no terminal."""
