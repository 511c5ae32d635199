"""A simulated robot in a simulated room: what it does and what it sees.

From outside: `world` and `room`, `view` and `grid` for how it looks, `pico` and `servos` for its
boards; `textures` is of `view`.
"""
