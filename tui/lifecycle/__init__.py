"""The way into a session and out of it: what is opened, how, and the dialogs that ask on the way.

It stands above the screens: they know it by `tui.frame.host.SessionDoor` alone.
"""
