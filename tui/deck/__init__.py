"""The first tab: the lesson's nodes, its panels, the log.

`screen` puts them together: the table of nodes, `panels` (which of `tui.panels` are there), the
log view, the dock of `tui.teleop`. From outside: `screen` for the app, and `actions` for what
names its keys.
"""
