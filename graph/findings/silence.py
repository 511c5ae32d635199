"""Topics that have fallen silent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.data import Trouble
from graph.findings.finding import FindingLevel, FindingPlace, GraphFinding
from graph.findings.names import is_deck, listed
from graph.housekeeping import is_housekeeping
from graph.qos import TRANSIENT_LOCAL
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator

    from graph.data import GraphUpdate, TopicRow
    from graph.findings.finding import GraphNorms

STREAMS = "sensor_msgs/msg/"
"""Types whose messages come all the time, if they come at all."""
RECORDED = "recorded"
"""The fact of a topic in a recording, which has no node to look at."""


def silences(update: GraphUpdate, norms: GraphNorms) -> Iterator[GraphFinding]:
    """Yield topics that were published regularly until they stopped, and sensors that never began.

    Whatever is published now and then, such as commands, may rest.
    """
    for row in update.topics:
        if row.trouble is not Trouble.QUIET or RECORDED in row.facts or is_housekeeping(row.name):
            continue
        if any(norms.moves(row.name, kind) for kind in row.type_names):
            continue
        nodes = sorted({end.node for end in row.published_by if not is_deck(end.node)})
        what = _what(row, listed(nodes)) if nodes else ""
        if what:
            yield GraphFinding(
                FindingLevel.WARNING,
                "silent",
                FindingPlace("topic", row.name),
                what,
                say("Look at the log of the node and at its device; start it again if it hangs."),
                tuple(nodes),
            )


def _what(row: TopicRow, nodes: str) -> str:
    if row.age_s is not None and row.steady_hz is not None:
        return say(
            "It came at {hz:.1f} Hz from {nodes}, and then nothing for {seconds:.0f} s.",
            nodes=nodes,
            hz=row.steady_hz,
            seconds=row.age_s,
        )
    latched = any(end.durability == TRANSIENT_LOCAL for end in row.published_by)
    streams = all(kind.startswith(STREAMS) for kind in row.type_names)
    if row.age_s is None and streams and not latched:
        return say("This sensor has not sent one message; it is published by {nodes}.", nodes=nodes)
    return ""
