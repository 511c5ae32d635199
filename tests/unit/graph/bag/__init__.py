"""Bags, on unusual files."""
