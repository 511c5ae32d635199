"""Tests of `tui.wall`: the screen, fed by recorded data."""
