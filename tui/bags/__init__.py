"""Dialogs about recordings: what one would contain, before it begins, and those there are.

Recording itself is `tui.recording`; playing is `tui.lifecycle`.
"""
