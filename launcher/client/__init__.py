"""The launcher for those who use it: start a profile, attach to a session, ask and listen.

From outside: `client` (launch, attach, running), `running` for which session is meant, `start` for
one that is begun ahead, `log_history`.
"""
