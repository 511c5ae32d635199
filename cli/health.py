"""Whether the nodes of a run are healthy, judging only by their statuses."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from launcher.status import NodeState, NodeStatus

OTHER_TYPE = " is published as "
"""Part of the supervisor's message about a topic of another type: waiting does not help."""


def settled(nodes: Mapping[str, NodeStatus]) -> bool:
    """Whether no node is still starting: each is ready, has ended, or is waiting in vain."""
    return not any(
        node.state is NodeState.STARTING
        or (node.state is NodeState.WAITING and all(nodes[name].serves for name in node.needs if name in nodes))
        for node in nodes.values()
    )


def over(nodes: Mapping[str, NodeStatus]) -> bool:
    """Whether every node has ended and none will be started again."""
    ended = (NodeState.EXITED, NodeState.FAILED)
    stuck = settled(nodes)
    return all(node.state in ended or (stuck and node.state is NodeState.WAITING) for node in nodes.values())


def well(node: NodeStatus, optional: Collection[str] = (), *, on_the_way: bool = False) -> bool:
    """Whether a node has done what its profile promised; call this before anything is stopped.

    `on_the_way`: nobody waited for the nodes to come up, so one that is still starting is healthy.
    """
    if node.name in optional:
        return True
    if node.ails:
        return False
    if on_the_way and node.state in (NodeState.STARTING, NodeState.WAITING):
        return not node.restarts and OTHER_TYPE not in node.detail
    if node.state is NodeState.EXITED:
        return not node.restarts and not node.exit_code and node.signal is None
    return node.serves and not node.restarts
