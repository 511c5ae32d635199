"""`ros2 interface`: one file a verb."""
