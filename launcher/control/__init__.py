"""The control socket: its protocol, and the supervisor's end.

From outside: `protocol` and `socket` for the client, `server` for the supervisor; `feed` is the
server's.
"""
