"""Tests of `tui.emergency`: the screen, fed by recorded data."""
