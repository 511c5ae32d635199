"""Frames of the serial devices in words, for a person who watches.

Drivers may import both modules, screens `protocols`.
"""
