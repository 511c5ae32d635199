"""Tests of `tui.panels`: the screen, fed by recorded data."""
