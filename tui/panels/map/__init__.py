"""The panel of the map: where the robot is and what is around it."""
