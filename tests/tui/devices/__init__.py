"""Tests of `tui.devices`: the screen, fed by recorded data."""
