"""Tests of `tui.logs`: the screen, fed by recorded data."""
