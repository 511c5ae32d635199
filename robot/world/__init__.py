"""A simulated robot in a simulated room: what it does and what it sees.

Other rooms may import `world` and `room`, `view` and `grid` for how it looks, `pico` and `servos`
for its boards; `textures` belongs to `view`.
"""
