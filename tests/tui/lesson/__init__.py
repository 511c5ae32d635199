"""Tests of the Lesson screen."""
