"""A robot that is not there, in a room that is not there: what it does and what it sees.

From outside: `world` and `room`, `view` and `grid` for how it looks, `pico` and `servos` for its
boards; `textures` is of `view`.
"""
