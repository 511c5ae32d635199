"""Nodes with a lifecycle, and what they answer about it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ros2.naming import absolute, servers

if TYPE_CHECKING:
    from ros2.joining import Guest

NOT_FOUND = "Node not found"
GET_STATE = "/get_state"
GET_STATE_TYPE = "lifecycle_msgs/srv/GetState"


def nodes(me: Guest, *, hidden: bool) -> list[str]:
    """Return the full names of the nodes that have a lifecycle, sorted."""
    return servers(me.node, GET_STATE, GET_STATE_TYPE, hidden=hidden)


def find(me: Guest, name: str, *, hidden: bool) -> str:
    """Return the full name of a node with a lifecycle once it is there, empty if it is not."""
    full = absolute(name)
    return full if me.await_until(lambda: full in nodes(me, hidden=hidden)) else ""


def state(me: Guest, node: str) -> Any:  # noqa: ANN401 - a message
    """Ask for the current state, a lifecycle_msgs/State."""
    from lifecycle_msgs.srv import GetState

    return me.call(f"{node}{GET_STATE}", GetState, node).current_state


def transitions(me: Guest, node: str, *, of_all: bool = False) -> list[Any]:
    """Ask for the transitions out of the current state, or for the whole graph of them."""
    from lifecycle_msgs.srv import GetAvailableTransitions

    name = "get_transition_graph" if of_all else "get_available_transitions"
    answer = me.call(f"{node}/{name}", GetAvailableTransitions, node)
    return list(answer.available_transitions)


def change(me: Guest, node: str, transition: Any) -> bool:  # noqa: ANN401 - a message
    """Ask for a transition; return whether it was made."""
    from lifecycle_msgs.srv import ChangeState

    answer = me.call(f"{node}/change_state", ChangeState, node, transition=transition)
    return bool(answer.success)
