"""Who stands in whose way: publishers that fight on a topic, nodes with one name."""

from __future__ import annotations

import os
from collections import Counter
from typing import TYPE_CHECKING

from graph.data import PROCESS_NUMBERS
from graph.findings.finding import FORGOTTEN_S, SETTLED_S, FindingLevel, FindingPlace, GraphFinding
from graph.findings.names import is_deck, listed
from graph.housekeeping import is_hidden
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from graph.data import GraphUpdate, TopicRow
    from graph.findings.finding import GraphNorms

CLOCK = "/clock"
DECK = "Deck"
"""What this screen is called in a sentence."""
PARTS = frozenset(
    {
        "diagnostic_msgs/msg/DiagnosticArray",
        "rcl_interfaces/msg/Log",
        "rcl_interfaces/msg/ParameterEvent",
        "tf2_msgs/msg/TFMessage",
        "visualization_msgs/msg/Marker",
        "visualization_msgs/msg/MarkerArray",
    }
)
"""Types of messages that are parts of a whole, to which everybody adds theirs."""
OF_EACH_NODE = ("/rosout", "/parameter_events")
"""A node has at most one publisher on each of these."""


def fights(update: GraphUpdate, norms: GraphNorms) -> Iterator[GraphFinding]:
    """Yield the topics on which several publishers send at once, or might where one must not."""
    for row in update.topics:
        if row.name in norms.of_many or PARTS & set(row.type_names) or is_hidden(row.name):
            continue
        names = [end.node for end in row.published_by if not is_deck(end.node)]
        names += [DECK] if row.own_publishers else []
        commands = any(norms.moves(row.name, kind) for kind in row.type_names)
        strict = row.name in norms.sole or row.name == CLOCK
        if len(names) < 2 or not (strict or row.several_send):
            continue
        yield GraphFinding(
            FindingLevel.ERROR if commands or strict else FindingLevel.WARNING,
            "fight",
            FindingPlace("topic", row.name),
            _fight_words(row, listed(names), commands=commands or row.name in norms.sole),
            say(
                "Stop all but one of them, or let the others publish another topic: remap it, or "
                "give them a namespace."
            ),
            tuple(sorted(set(names) - {DECK})),
            # Two of one name may be a node that was killed and its successor.
            FORGOTTEN_S if len(set(names)) < len(names) else SETTLED_S,
        )


def _fight_words(row: TopicRow, nodes: str, *, commands: bool) -> str:
    if row.name == CLOCK:
        return say("Several clocks are published, and time jumps between them: {nodes}", nodes=nodes)
    if commands and row.several_send:
        return say("Several nodes command at once, and whoever spoke last is obeyed: {nodes}", nodes=nodes)
    if commands:
        return say("Several nodes may command, and whoever spoke last is obeyed: {nodes}", nodes=nodes)
    return say("Messages of several publishers are mixed: {nodes}", nodes=nodes)


def namesakes(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield the names that more than one node has."""
    twice: set[str] = set()
    for row in update.topics:
        if row.name in OF_EACH_NODE:
            counted = Counter(end.node for end in row.published_by if end.is_named)
            twice |= {name for name, count in counted.items() if count > 1}
    for node in update.nodes:
        if is_hidden(node.name) or not (node.name in twice or len(node.processes) > 1):
            continue
        yield GraphFinding(
            FindingLevel.ERROR,
            "namesakes",
            FindingPlace("node", node.name),
            say(
                "Several nodes have this name: parameters and services reach any one of them, and "
                "nobody can tell their messages apart."
            ),
            say(
                "Stop the one that was left running, or give one another name: `--ros-args -r __node:=another_name`."
            ),
            (node.name,),
            SETTLED_S if _run_here(node.processes) else FORGOTTEN_S,
        )


def _run_here(numbers: Collection[int]) -> bool:
    """Whether these are several processes of this machine, so that none is only remembered."""
    here = {int(name) % PROCESS_NUMBERS for name in os.listdir("/proc") if name.isdigit()}  # noqa: PTH208
    return len(numbers) > 1 and here.issuperset(numbers)
