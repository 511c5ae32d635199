"""The supervisor: the process that starts a session's nodes, monitors them, and ends them.

Other packages use `plan`, its input, `words.who`, and `python -m launcher.supervisor`; everything
else runs only in that process.
"""
