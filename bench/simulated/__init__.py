"""Measurements without ROS: the robot in its simulated world."""
