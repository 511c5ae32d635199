"""Tests of `tui.deck`: the screen, fed by recorded data."""
