"""`deck shell`, and what is found in it: `ros2`, colcon, a package of one's own."""
