"""Whether the nodes of a run are healthy, judged by their statuses alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launcher.status import NodeState

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from launcher.status import NodeStatus

OTHER_TYPE = " is published as "
"""In the supervisor's words about a topic of another type, which waiting does not change."""


def settled(nodes: Mapping[str, NodeStatus]) -> bool:
    """Whether nothing is on its way up: each node is ready, has ended, or waits in vain."""
    return not any(
        node.state is NodeState.STARTING
        or (
            node.state is NodeState.WAITING
            and all(nodes[name].serves for name in node.needs if name in nodes)
        )
        for node in nodes.values()
    )


def over(nodes: Mapping[str, NodeStatus]) -> bool:
    """Whether every node has ended and none will be started again."""
    ended = (NodeState.EXITED, NodeState.FAILED)
    stuck = settled(nodes)
    return all(
        node.state in ended or (stuck and node.state is NodeState.WAITING)
        for node in nodes.values()
    )


def well(node: NodeStatus, optional: Collection[str] = (), *, on_the_way: bool = False) -> bool:
    """Whether a node has done what its profile promised; asked before anything is stopped.

    `on_the_way`: nobody waited until the nodes were up, so one that is not yet is none the worse.
    """
    if node.name in optional:
        return True
    if on_the_way and node.state in (NodeState.STARTING, NodeState.WAITING):
        return not node.restarts and OTHER_TYPE not in node.detail
    if node.state is NodeState.EXITED:
        return not node.restarts and not node.exit_code and node.signal is None
    return node.serves and not node.restarts
