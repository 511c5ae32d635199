"""Tests of the course that have real nodes judged."""
