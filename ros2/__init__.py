"""The command `ros2` for those who have no ROS: the real one's options, output and exit codes.

Nothing else of Deck imports it. A shell starts it as `python -m ros2`; where a real ROS is sourced,
the real one runs instead. Like the real one, it speaks English only.
"""
