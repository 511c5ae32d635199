"""Two incompatible endpoints, in a sentence with the two ways to fix them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.qos_compatibility import DEADLINE, LEASE
from text.i18n import N_, _, localized, ngettext
from text.plain import plain
from tui.widgets.figures import seconds_text

if TYPE_CHECKING:
    from collections.abc import Mapping

LONGEST = 400
_ANY_POLICY = N_(
    "{subscriber} does not hear {publisher}: {policy} {requested} is asked for, {offered} is "
    "offered. Let {publisher} offer {requested}, or let {subscriber} ask for {offered}."
)
_TIMES = {
    (DEADLINE, True): N_(
        "{subscriber} does not hear {publisher}: it asks for a message at least every {requested} "
        "(deadline), {offered} is offered. Let {publisher} offer {requested} or less, or let "
        "{subscriber} ask for {offered} or more."
    ),
    (DEADLINE, False): N_(
        "{subscriber} does not hear {publisher}: it asks for a message at least every {requested} "
        "(deadline), no deadline is offered. Let {publisher} offer {requested} or less, or let "
        "{subscriber} ask for none."
    ),
    (LEASE, True): N_(
        "{subscriber} does not hear {publisher}: it asks for a sign of life at least every "
        "{requested} (liveliness lease duration), {offered} is offered. Let {publisher} offer "
        "{requested} or less, or let {subscriber} ask for {offered} or more."
    ),
    (LEASE, False): N_(
        "{subscriber} does not hear {publisher}: it asks for a sign of life at least every "
        "{requested} (liveliness lease duration), none is offered. Let {publisher} offer "
        "{requested} or less, or let {subscriber} ask for none."
    ),
}
"""By the policy, and whether the publisher offers such a time at all."""


def pair_words(facts: Mapping[str, str]) -> str:
    """Who does not hear whom, and the two fixes, from the facts of a `Trouble.QOS_MISMATCH`."""
    policy, offered = facts["policy"], facts["offered"]
    ends = {end: localized(facts[end]) for end in ("publisher", "subscriber")}
    template = _TIMES.get((policy, bool(offered)))
    if template is None:
        return plain(_(_ANY_POLICY).format(**{**facts, **ends}), LONGEST)
    times = {
        "requested": seconds_text(float(facts["requested"])),
        "offered": seconds_text(float(offered)) if offered else "",
    }
    return plain(_(template).format(**{**facts, **ends, **times}), LONGEST)


def misfit_words(facts: Mapping[str, str]) -> str:
    """The first pair in a sentence, and the number of further ones."""
    words = pair_words(facts)
    more = int(facts.get("more", "0"))
    if not more:
        return words
    return f"{words} {ngettext('… and {n} more pair', '… and {n} more pairs', more).format(n=more)}"
