"""Tests of `tui.picker`: the screen, fed by recorded data."""
