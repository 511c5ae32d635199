"""Tests of `tui.composer`: the screen, fed by recorded data."""
