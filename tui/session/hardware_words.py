"""What the nodes of a session move and hear, in a word: a robot, or what stands in its place."""

from __future__ import annotations

from text.i18n import N_, _
from text.plain import plain

WORDS = {"mock": N_("mock"), "real": N_("real")}
"""As `--hardware` has them."""


def hardware_words(hardware: str) -> str:
    """Return `mock` or `real` in the language of the screen; anything else as it is."""
    return _(WORDS[hardware]) if hardware in WORDS else plain(hardware)
