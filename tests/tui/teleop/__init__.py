"""Tests of `tui.teleop`: the screen, fed by recorded data."""
