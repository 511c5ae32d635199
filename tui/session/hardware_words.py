"""The hardware of a session in one word: a real robot, or a mock."""

from __future__ import annotations

from text.i18n import N_, _
from text.plain import plain

WORDS = {"mock": N_("mock"), "real": N_("real")}
"""The values of `--hardware`."""


def hardware_words(hardware: str) -> str:
    """Return `mock` or `real` in the current language; anything else unchanged."""
    return _(WORDS[hardware]) if hardware in WORDS else plain(hardware)
