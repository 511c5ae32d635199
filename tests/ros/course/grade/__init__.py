"""Tests of grading with real nodes, most of them hostile."""
