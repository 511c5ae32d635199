"""The launcher for those who use it: start a profile, attach to a session, ask and listen."""
