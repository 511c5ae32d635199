"""When the robot may move: distances, sources, the emergency stop."""
