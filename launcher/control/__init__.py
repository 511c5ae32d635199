"""The control socket: what is said on it, and the supervisor's end."""
