"""Recording a session: `recording.Recording` starts, monitors and stops it; `words` describe it.

The keys for it are in `tui.frame.actions`; reading and writing bags is in `graph`.
"""
