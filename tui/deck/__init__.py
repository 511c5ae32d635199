"""The Deck tab: the lesson's nodes, its panels and the log.

`screen` puts together the table of nodes, the grid of `tui.panels`, the log view and the dock of `tui.teleop`. Other
rooms import only `screen` (for the app) and `actions` (for the names of its keys).
"""
