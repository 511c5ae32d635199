"""Tests of `brain` against real sockets; they need no ROS and no terminal."""
