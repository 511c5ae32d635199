"""Devices and rooms that are not there.

For the `mock_` nodes, and for `drive_to_point` where it moves a robot that is not there.
"""
