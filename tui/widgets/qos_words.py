"""Two incompatible endpoints, in a sentence with the two ways to fix them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import localized
from text.plain import plain

if TYPE_CHECKING:
    from graph.qos import Mismatch

LONGEST = 400


def pair_words(pair: Mismatch) -> str:
    """Who does not hear whom, and the two fixes."""
    return plain(f"{localized(pair.what)} {localized(pair.mend)}", LONGEST)
