"""Frames of the serial devices in words, for a person who looks on."""
