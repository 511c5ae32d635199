"""`ros2 component`: containers and what they hold."""
