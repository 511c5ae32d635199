"""`ros2 action`: one file a verb."""
