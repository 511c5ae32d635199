"""How the robot moves: odometry, the way to a point, the head.

Each module may be used on its own.
"""
