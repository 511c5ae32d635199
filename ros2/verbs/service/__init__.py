"""`ros2 service`: one file a verb."""
