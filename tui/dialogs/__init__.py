"""Dialogs and pages that belong to no screen: a new dialog inherits `dialog.Dialog`.

Those that ask on the way into a session or out of it are in `tui.lifecycle`.
"""
