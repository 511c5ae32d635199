"""Driving by keys."""
