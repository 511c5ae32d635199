"""Suggestions for mistyped input: the nearest known word, or the number that was meant."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterable

LONGEST = 100
"""How many characters of a word are compared: input may have any length."""


def near(word: str, known: Iterable[str], *, most: int = 1, cutoff: float = 0.6) -> list[str]:
    """Return the known words that are similar, the most similar first."""
    from difflib import get_close_matches  # Rarely needed, and slow to import.

    return get_close_matches(word[:LONGEST], list(known), n=most, cutoff=cutoff)


def nearest(word: str, known: Iterable[str]) -> str:
    """Return the known word that was probably meant, empty if none is similar."""
    return next(iter(near(word, known)), "")


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return the hint that names what was probably meant, empty if nothing is similar."""
    meant = nearest(word, known)
    return say("did you mean {word}?", word=meant) if meant else ""


def no_number(value: object, shown: str) -> str:
    """Say that a number was expected; for `0,5`, that a fraction is written with a point."""
    if isinstance(value, str) and (comma := _DECIMAL_COMMA.fullmatch(value.strip())):
        return say("write a fraction with a point: {mended}", mended=".".join(comma.groups()))
    if isinstance(value, str) and (dash := _DASH.fullmatch(value.strip())):
        return say("write the minus as on the keyboard: {mended}", mended=f"-{dash[1]}")
    return say("expected a number, got {value}", value=shown)


_DASH = re.compile(r"[\N{MINUS SIGN}\N{EN DASH}\N{EM DASH}] ?([0-9]+(?:\.[0-9]*)?)")
"""What a text processor makes of a minus."""
_DECIMAL_COMMA = re.compile(r"([-+]?[0-9]+),([0-9]+)")
