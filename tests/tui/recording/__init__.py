"""Tests of `tui.recording`: the screen, fed by recorded data."""
