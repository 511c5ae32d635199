"""How the robot moves: odometry, the way to a point, the head, angles in space.

Each module may be used on its own.
"""
