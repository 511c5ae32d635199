"""`ros2 lifecycle`: nodes with a lifecycle, their states and transitions."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from ros2 import options, rows
from ros2.joining import joined
from ros2.naming import absolute, servers
from ros2.verb import arg, flag, verb
from text.plain import plain

if TYPE_CHECKING:
    import argparse

    from ros2.joining import Guest

NOT_FOUND = "Node not found"
GET_STATE = "/get_state"
GET_STATE_TYPE = "lifecycle_msgs/srv/GetState"
NODE = (
    options.of_graph, options.answers, arg("node_name", help="Name of the ROS node"), options.hidden("nodes"),
)  # fmt: skip


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


@verb("lifecycle nodes", "Output a list of nodes with lifecycle", options.of_node_list)
def list_nodes(args: argparse.Namespace) -> None:
    """Print them in order."""
    with joined(args, settled=True) as me:
        names = nodes(me, hidden=args.all)
    rows.print_names(names, count=args.count_nodes)


@verb(
    "lifecycle get", "Get lifecycle state for one or more nodes", options.of_graph, options.answers,
    arg(
        "node_name", nargs="?",
        help="Name of the ROS node. If no name is provided, then get the state for all nodes.",
    ),
    options.hidden("nodes"),
)  # fmt: skip
def get(args: argparse.Namespace) -> int | str | None:
    """Print it; a node that does not answer makes the exit code 1, after all others."""
    with joined(args, settled=not args.node_name) as me:
        if args.node_name:
            node = find(me, args.node_name, hidden=args.hidden)
            if not node:
                return NOT_FOUND
            now = state(me, node)
            print(f"{plain(now.label)} [{now.id}]")
            return None
        told = [_print_state(me, node) for node in nodes(me, hidden=args.hidden)]
    return 0 if all(told) else 1


def _print_state(me: Guest, node: str) -> bool:
    try:
        now = state(me, node)
    except RuntimeError as error:
        print(error, file=sys.stderr)
        return False
    print(f"{node}: {plain(now.label)} [{now.id}]")
    return True


@verb(
    "lifecycle list", "Output a list of available transitions", *NODE,
    flag("-a", "--all", help="Display all existing transitions, not only those available now"),
)  # fmt: skip
def list_transitions(args: argparse.Namespace) -> str | None:
    """Print each with where it begins and where it leads."""
    with joined(args) as me:
        node = find(me, args.node_name, hidden=args.hidden)
        if not node:
            return NOT_FOUND
        for each in transitions(me, node, of_all=args.all):
            print(
                f"- {plain(each.transition.label)} [{each.transition.id}]\n"
                f"\tStart: {plain(each.start_state.label)}\n"
                f"\tGoal: {plain(each.goal_state.label)}"
            )
    return None


@verb(
    "lifecycle set", "Trigger lifecycle state transition", *NODE,
    arg("transition", help="The lifecycle transition"),
)  # fmt: skip
def set_state(args: argparse.Namespace) -> str | None:
    """Trigger it by its name or number; unlike in the real tool, a failure is exit code 1."""
    from lifecycle_msgs.srv import ChangeState

    with joined(args) as me:
        node = find(me, args.node_name, hidden=args.hidden)
        if not node:
            return NOT_FOUND
        known = [each.transition for each in transitions(me, node)]
        wanted = [each for each in known if args.transition in (each.label, str(each.id))]
        if not wanted:
            lines = "".join(f"\n- {each.label} [{each.id}]" for each in known)
            return f"Unknown transition requested, available ones are:{lines}"
        answer = me.call(f"{node}/change_state", ChangeState, node, transition=wanted[0])
    if not answer.success:
        return "Transitioning failed"
    print("Transitioning successful")
    return None
