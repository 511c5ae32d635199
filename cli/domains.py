"""The ROS domain of a command: the running robot's by default; who else is in it, and whether a stop is in force."""

from __future__ import annotations

import os
from argparse import Namespace
from typing import TYPE_CHECKING

from launcher.domain.discovery import OF_PEERS, RANGE, VARIABLES
from launcher.domain.domain import choose_domain
from launcher.errors import DomainTakenError, UsageError
from launcher.profile.catalog import find_profile
from launcher.runs.shared_domain import apart_from_classmates, refuse_shared_domain
from robot.safety.stop_file import stop_place
from text.i18n import _, localized
from text.output import say_error
from text.sentences import say

if TYPE_CHECKING:
    from launcher.profile.load import Profile


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


def profile_to_run(options: Namespace) -> Profile:
    """Return the profile of a command line in the domain it is to run in, and say what has to be said of it."""
    # Validation imports pydantic, which most commands do not need.
    from launcher.profile.load import load_profile
    from launcher.serial_ports import serial_ports

    profile = load_profile(
        find_profile(options.profile),
        hardware=options.hardware,
        overrides=options.overrides,
        domain=options.domain,
        ports=serial_ports,
    )
    settled = apart_from_classmates(profile)
    if settled.domain != profile.domain:
        words = _("somebody else on this account is in domain {taken}: this one runs in domain {domain}")
        say_error(words.format(taken=profile.domain, domain=settled.domain))
    try:
        refuse_shared_domain(settled)
    except DomainTakenError as taken:
        # The supervisor refuses those that exclude each other.
        if taken.can_share:
            say_error(localized(taken.args[0]))
            say_error(_("their nodes will see each other"))
    return settled


def stop_is_kept(domain: int) -> bool:
    """Whether a stop is recorded for this domain, even from an earlier session."""
    try:
        return os.path.lexists(stop_place(domain))
    except (OSError, RuntimeError):
        # No stop can be kept there; the nodes report that themselves.
        return False


def stop_words(domain: int) -> str:
    """Return the warning about the stop, and how to release it."""
    words = _(
        "■ EMERGENCY STOP in domain {domain}: its robot does not move until the stop is released;"
        " `deck watch --domain {domain}`, then Ctrl+R"
    )
    return words.format(domain=domain)
