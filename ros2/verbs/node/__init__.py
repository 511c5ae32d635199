"""`ros2 node`: one file a verb."""
