"""Two incompatible endpoints, in a sentence with the two ways to fix them."""

from __future__ import annotations

from collections.abc import Mapping

from graph.qos_compatibility import Mismatch
from text.i18n import localized, ngettext
from text.plain import plain

LONGEST = 400


def pair_words(pair: Mismatch) -> str:
    """Who does not hear whom, and the two fixes."""
    return plain(f"{localized(pair.what)} {localized(pair.mend)}", LONGEST)


def misfit_words(facts: Mapping[str, str]) -> str:
    """The first pair in a sentence and the number of further ones, from a trouble's facts."""
    words = pair_words(Mismatch(**{name: facts[name] for name in Mismatch.__match_args__}))
    more = int(facts.get("more", "0"))
    if not more:
        return words
    return f"{words} {ngettext('… and {n} more pair', '… and {n} more pairs', more).format(n=more)}"
