"""QoS that keeps messages from arriving, and messages that were lost."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.findings.finding import FindingLevel, FindingPlace, GraphFinding
from graph.housekeeping import is_hidden
from graph.qos import BEST_EFFORT
from graph.qos_compatibility import mismatches
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator

    from graph.data import GraphUpdate, TopicRow

FEWEST_LOST = 20
LOST_SHARE = 0.05
"""A loss below these may happen on any busy machine."""
SHALLOW = 5
"""Depth of a queue that a burst overflows."""


def misfits(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield topics on which some subscriber does not hear some publisher, by their QoS."""
    for row in update.topics:
        found = list(dict.fromkeys(mismatches(row.published_by, row.subscribed_by)))
        if not found or is_hidden(row.name):
            continue
        what, more = found[0].what, len(found) - 1
        if more:
            what = say("{what} (and {more} more such pairs)", what=what, more=more)
        nodes = {name for pair in found for name in (pair.publisher, pair.subscriber)}
        yield GraphFinding(
            FindingLevel.ERROR, "qos", FindingPlace("topic", row.name), what, found[0].mend, tuple(sorted(nodes))
        )


def losses(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield topics of which messages have been lost on the way to Deck."""
    for row in update.topics:
        lost = row.lost or 0
        if lost < FEWEST_LOST or lost < LOST_SHARE * (row.count + lost) or is_hidden(row.name):
            continue
        unreliable = any(end.reliability == BEST_EFFORT for end in row.published_by)
        what, mend = _lost_best_effort(row, lost) if unreliable else _lost_reliable(row, lost)
        yield GraphFinding(
            FindingLevel.WARNING,
            "lost",
            FindingPlace("topic", row.name),
            what,
            mend,
            tuple(sorted({end.node for end in row.published_by})),
        )


def _lost_best_effort(row: TopicRow, lost: int) -> tuple[str, str]:
    what = say(
        "{lost} of {sent} messages were lost on the way; with best_effort nobody sends them again.",
        lost=lost,
        sent=row.count + lost,
    )
    return what, say("Publish smaller messages or fewer a second; or offer reliable, if each of them matters.")


def _lost_reliable(row: TopicRow, lost: int) -> tuple[str, str]:
    what = say(
        "{lost} of {sent} messages were lost, although reliable: newer ones have replaced them in "
        "the publisher's queue.",
        lost=lost,
        sent=row.count + lost,
    )
    depth = min((end.depth for end in row.published_by if end.depth), default=0)
    if 0 < depth < SHALLOW:
        return what, say(
            "Give the publisher a deeper queue than {depth}, or let it publish less at once.", depth=depth
        )
    return what, say("Give the publisher a deeper queue, or let it publish less at once.")
