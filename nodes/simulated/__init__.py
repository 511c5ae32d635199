"""Devices and rooms that are not there."""
