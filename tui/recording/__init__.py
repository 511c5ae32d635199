"""Recording what runs: begun, looked at and ended by `recording.Recording`, told by `words`.

The keys for it are in `tui.frame.actions`; what reads and writes bags is in `graph`.
"""
