"""Tests of `tui.topics`: the screen, fed by recorded data."""
