"""Frames and shapes in space: pure functions and plain data, without ROS and without a screen.

Units are metres and radians, axes as in REP-103: x forward, y to the left, z up. Quaternions are
(x, y, z, w).
"""
