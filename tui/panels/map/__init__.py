"""The Map panel: where the robot is, and what is around it."""
