"""`ros2 param`: one file a verb."""
