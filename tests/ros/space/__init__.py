"""Tests of `space` with real messages, and of the Space screen's layers with real publishers."""
