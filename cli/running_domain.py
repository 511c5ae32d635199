"""The default domain of a command: that of the running robot."""

from __future__ import annotations

import os

from launcher.domain.discovery import OF_PEERS, RANGE, VARIABLES
from launcher.domain.domain import choose_domain
from launcher.errors import UsageError
from text.sentences import say


def running_domain(asked: int | None, wanted: str | None = None) -> tuple[str, int, str | tuple[str, ...]]:
    """Return name, domain and discovery: those of the robot that Deck runs, else the environment's.

    `asked` and `wanted`: the domain and the discovery of the command line, which go before these.

    Raises:
        UsageError: if robots run in several domains.
    """
    from launcher.client.client import running

    sessions = [one for one in running() if asked is None or one.domain == asked]
    domains = sorted({one.domain for one in sessions})
    if len(domains) > 1:
        named = ", ".join(map(str, domains))
        raise UsageError(say("robots are running in domains {domains}: choose one with --domain", domains=named))
    if sessions:
        return sessions[0].name, sessions[0].domain, wanted or sessions[0].discovery
    wide = os.environ.get(RANGE, "").upper() == "SUBNET" and os.environ.get(VARIABLES[0]) != str(OF_PEERS)
    domain = choose_domain(asked, None, os.environ)
    return f"domain-{domain}", domain, wanted or ("subnet" if wide else "localhost")


def beyond_this_machine(discovery: str | tuple[str, ...]) -> str:
    """Return where else somebody may be who was not found, empty if that was looked at."""
    if discovery != "localhost":
        return ""
    return say("only this machine was looked at: --discovery subnet looks on the network, too")
