"""A bag instead of a robot: the same interface as the observer's, without ROS.

Other rooms may import `replay.Replay` and `player.ReplayState`.
"""
