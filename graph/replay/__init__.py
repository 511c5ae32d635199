"""A bag in place of a robot: the same interface as the observer's, without ROS.

From outside: `replay.Replay`, and how it stands, `state`.
"""
