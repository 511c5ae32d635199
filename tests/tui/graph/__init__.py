"""Tests of `tui.graph`: the screen, fed by recorded data."""
