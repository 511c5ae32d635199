"""Tests of grading without nodes: formats, folders, names."""
