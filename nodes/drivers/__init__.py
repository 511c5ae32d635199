"""What real devices need: serial ports, cameras and sound that come and go.

For nodes of real devices; no simulated one needs anything of it.
"""
