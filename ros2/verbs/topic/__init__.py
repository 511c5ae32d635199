"""`ros2 topic`: one file a verb."""
