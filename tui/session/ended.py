"""What remains of a session that has ended by itself: stopped nodes, silent topics.

Neither is updated any more, so the last known state must not look as if it were current.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from graph.data import GraphUpdate, TopicRow, Trouble
from launcher.status import NodeState

if TYPE_CHECKING:
    from launcher.status import NodeStatus


def ended_nodes(nodes: Mapping[str, NodeStatus], reason: str) -> dict[str, NodeStatus]:
    """Return the nodes, with those that were still running marked as ended for this `reason`."""
    return {name: _ended(node, reason) for name, node in nodes.items()}


def _ended(node: NodeStatus, reason: str) -> NodeStatus:
    if node.state in {NodeState.EXITED, NodeState.FAILED}:
        return node
    return replace(
        node, state=NodeState.EXITED, detail=reason, pid=None, uptime_s=None, cpu_percent=None, memory_bytes=None
    )


def silent_graph(update: GraphUpdate) -> GraphUpdate:
    """Return the graph with no publishers and no subscribers."""
    topics = tuple(map(_silent, update.topics))
    return replace(update, samples={}, seen_goals=(), frames=(), topics=topics)


def _silent(row: TopicRow) -> TopicRow:
    # Without an age, since nothing would update it.
    return TopicRow(row.name, row.type_names, 0, 0, count=row.count, trouble=Trouble.NO_PUBLISHER)
