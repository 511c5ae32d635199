"""The client side of the launcher: start a profile, attach to a session, control and follow it.

Other packages use `client` (launch, attach, running), `running` to find the session that a name
means, and `start` to start a supervisor in advance.
"""
