"""Tests of the observer, in its own process or on a thread, among real nodes."""
