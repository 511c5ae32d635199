"""A simulated robot in a simulated room: what it does and what it sees.

Other rooms may import `world`, `view` and `grid` for how it looks, and `boards`.
"""
