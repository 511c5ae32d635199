"""Measurements of the Space screen."""
