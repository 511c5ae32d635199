"""The supervisor: a process that starts a session's nodes, watches them, and ends them.

From outside: `plan`, what it is given, and `python -m launcher.supervisor`; all else runs in that
process only.
"""
