"""Types that do not agree, or are not installed."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from graph.data import Trouble
from graph.findings.finding import FindingLevel, FindingPlace, GraphFinding
from graph.findings.names import listed
from graph.housekeeping import is_hidden
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator

    from graph.data import ActionRow, GraphUpdate, ServiceRow, TopicRow
    from graph.findings.finding import PlaceKind

MOST = 3
"""Types that are written out."""


def disagreements(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield topics, services and actions that are used with more than one type."""
    for row in update.topics:
        if len(row.type_names) > 1 and not is_hidden(row.name):
            ends = (*row.published_by, *row.subscribed_by)
            yield _finding("topic", row, _who_uses(row), tuple(sorted({end.node for end in ends})))
    for service in update.services:
        kinds = sorted({*service.type_names, *service.called_as})
        if len(kinds) > 1 and not is_hidden(service.name):
            callers = [node.name for node in update.nodes if service.name in node.clients]
            yield _finding("service", service, ", ".join(kinds[:MOST]), (*service.nodes, *callers))
    for action in update.actions:
        if len(action.type_names) > 1 and not is_hidden(action.name):
            words = ", ".join(action.type_names[:MOST])
            yield _finding("action", action, words, (*action.servers, *action.clients))


def _who_uses(row: TopicRow) -> str:
    """Return `std_msgs/msg/Bool (/a), std_msgs/msg/Int8 (/b)`."""
    users: defaultdict[str, list[str]] = defaultdict(list)
    for end in (*row.published_by, *row.subscribed_by):
        users[end.type_name].append(end.node)
    told = [f"{kind} ({listed(set(users[kind]))})" if users[kind] else kind for kind in row.type_names]
    return ", ".join(told[:MOST])


def _finding(
    kind: PlaceKind, row: TopicRow | ServiceRow | ActionRow, types: str, nodes: tuple[str, ...]
) -> GraphFinding:
    return GraphFinding(
        FindingLevel.ERROR,
        "two-types",
        FindingPlace(kind, row.name),
        say("It is used with types that do not agree, so not everybody is reached: {types}", types=types),
        say("Let all use one type, or give one of them another name."),
        tuple(dict.fromkeys(nodes)),
    )


def missing(update: GraphUpdate) -> Iterator[GraphFinding]:
    """Yield topics whose type is not installed here, unless peers disagree about it anyway."""
    for row in update.topics:
        if row.trouble is not Trouble.UNKNOWN_TYPE or len(row.type_names) > 1:
            continue
        yield GraphFinding(
            FindingLevel.WARNING,
            "unknown-type",
            FindingPlace("topic", row.name),
            say(
                "Its messages cannot be read here: {type} is unknown, or another version of it.",
                type=", ".join(row.type_names) or "?",
            ),
            row.detail,
            tuple(sorted({end.node for end in row.published_by})),
        )
