"""The list of lessons and of running sessions: what can be opened, and what is in it.

Only `screen` is used elsewhere, by the app. Dialogs before opening are in `tui.lifecycle`, which
opens the session.
"""
