"""Frames of the serial devices, to bytes and back; each module is one protocol."""
