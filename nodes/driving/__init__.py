"""Driving to a point, and driving for a while: goals, repetition, words."""
