"""Frames of the serial devices, to bytes and back; each module is one protocol.

From outside: a protocol's module; `crc` and `line` are what they share.
"""
