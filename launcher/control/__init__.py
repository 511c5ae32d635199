"""The control socket, and the supervisor's end of it.

The client uses `socket`, the supervisor `server`; the protocol is `launcher.wire`.
"""
