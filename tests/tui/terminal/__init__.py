"""Tests of `tui.terminal`: the screen, fed by recorded data."""
