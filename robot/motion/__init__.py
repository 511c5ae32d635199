"""How the robot moves: kinematics, odometry, the way to a point, the head."""
