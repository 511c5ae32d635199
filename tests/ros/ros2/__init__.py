"""The command `ros2` against real nodes."""
