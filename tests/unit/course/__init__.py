"""Tests of the course without nodes."""
