"""`ros2 bag`: recordings."""
