"""Tests that drive deck in a real terminal."""
