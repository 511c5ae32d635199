"""Programs of other packages that the course runs by `ros2 run`: those of tf2_ros."""
