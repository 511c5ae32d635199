"""The control socket: its protocol, and the supervisor's end.

The client uses `protocol` and `socket`, the supervisor `server`; `feed` belongs to the server.
"""
