"""Simulated devices and rooms.

For the `mock_` nodes, and for `drive_to_point` when it moves a simulated robot.
"""
