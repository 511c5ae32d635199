"""Dialogs and pages that belong to no particular screen: a new dialog inherits `dialog.Dialog`.

Dialogs about opening and closing sessions are in `tui.lifecycle`.
"""
