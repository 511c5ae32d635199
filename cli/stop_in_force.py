"""Says on the command line that an emergency stop is in force, and how it is released."""

from __future__ import annotations

import os

from robot.safety.stop_place import stop_place
from text.i18n import _


def stop_is_kept(domain: int) -> bool:
    """Whether a stop is remembered in this domain, be it of an earlier session."""
    try:
        return os.path.lexists(stop_place(domain))
    except (OSError, RuntimeError):
        # Nobody can keep one there; the nodes have words for it.
        return False


def stop_words(domain: int) -> str:
    """Return what is in force, and the way out of it."""
    words = _(
        "■ EMERGENCY STOP in domain {domain}: its robot does not move until the stop is released;"
        " `deck watch --domain {domain}`, then Ctrl+R"
    )
    return words.format(domain=domain)
