"""When this robot may move: distances, and who is obeyed. Its emergency stop is in the room `safety`.

Each module is one rule, and may be used on its own.
"""
