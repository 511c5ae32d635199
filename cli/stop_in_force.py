"""Reporting, on the command line, an emergency stop in force and how to release it."""

from __future__ import annotations

import os

from robot.safety.stop_file import stop_place
from text.i18n import _


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
