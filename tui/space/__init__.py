"""What is where: frames, the robot, its map and what its sensors see."""
