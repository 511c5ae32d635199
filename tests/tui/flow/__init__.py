"""Tests of `tui.flow`: the screen, fed by recorded data."""
