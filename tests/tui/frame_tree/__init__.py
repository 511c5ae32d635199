"""Tests of `tui.frame_tree`: the screen, fed by recorded data."""
