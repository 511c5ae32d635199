"""A bag in place of a robot: the same answers as the observer's, with no ROS at hand.

From outside: `replay.Replay`, and how it stands, `state`.
"""
