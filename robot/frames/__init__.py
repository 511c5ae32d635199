"""Frames of the serial devices in words, for a person who looks on.

From outside: `batches` and a device's own module for drivers, `lines` for screens.
"""
