"""Opening and closing a session, and the dialogs that ask questions on the way.

It is above the screens, which know it only as `tui.frame.host.SessionControl`. The app uses
`sessions`, and `tui.live` makes its `opener`.
"""
