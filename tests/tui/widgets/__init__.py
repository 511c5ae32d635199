"""Tests of `tui.widgets`: the screen, fed by recorded data."""
