"""Widgets: plain data in by methods, Textual messages out."""
