"""The supervisor: a process that starts a session's nodes, watches them, and ends them."""
