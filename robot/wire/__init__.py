"""Converts frames of the serial devices to bytes and back; each module is one protocol.

Other rooms may import the modules of protocols, which share `line`.
"""
