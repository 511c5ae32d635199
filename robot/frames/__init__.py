"""Frames of the serial devices in words, for a person who watches.

Drivers may import `batches`, `protocols` and a device's own module; screens may import `lines` and
`protocols`.
"""
