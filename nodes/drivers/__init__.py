"""Support for real devices: serial ports, cameras and sound devices that come and go.

For nodes of real devices; the simulated ones do not use it.
"""
