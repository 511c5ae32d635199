"""Simulated devices and rooms.

For the `mock_` nodes, and for `drive_to_point` where it moves a robot that is not there.
"""
