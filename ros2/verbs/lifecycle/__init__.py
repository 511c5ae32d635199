"""`ros2 lifecycle`: nodes with a lifecycle, their states and transitions."""
