"""Tests of the viewers beside the screen."""
