"""When the robot may move: distances, sources, the emergency stop.

Each module is one rule, and may be used on its own.
"""
