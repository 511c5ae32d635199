"""`ros2 lifecycle`: the states of nodes with a lifecycle, and their transitions."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from graph.calls.lifecycle import GET_STATE, GET_STATE_TYPE, SERVICES, ChangeFacts, change, why_not
from ros2 import naming
from ros2.joining import joined
from ros2.verb import ANSWERS, OF_GRAPH, arg, verb
from text.i18n import localized
from text.plain import plain

if TYPE_CHECKING:
    import argparse

    from ros2.joining import Guest

NOT_FOUND = "Node not found"


@verb(
    "lifecycle get", "Get lifecycle state for one or more nodes", OF_GRAPH, ANSWERS,
    arg("node_name", nargs="?", help="Name of the ROS node; without one, the states of all nodes are printed"),
)  # fmt: skip
def get(args: argparse.Namespace) -> int | str | None:
    """Print it; a node that does not answer makes the exit code 1, after all others."""
    with joined(args, settled=not args.node_name) as me:
        if args.node_name:
            node = me.find(args.node_name, GET_STATE)
            if not node:
                return NOT_FOUND
            print(_state(me, node))
            return None
        serving = dict(me.node.get_service_names_and_types())
        code = 0
        for node in sorted(set(naming.nodes(me.node, hidden=False))):
            if GET_STATE_TYPE in serving.get(f"{node}/{GET_STATE}", ()):
                try:
                    print(f"{node}: {_state(me, node)}")
                except RuntimeError as error:
                    print(error, file=sys.stderr)
                    code = 1
    return code


def _state(me: Guest, node: str) -> str:
    from lifecycle_msgs.srv import GetState

    now = me.call(f"{node}/{GET_STATE}", GetState, node).current_state
    return f"{plain(now.label)} [{now.id}]"


@verb(
    "lifecycle set", "Trigger lifecycle state transition", OF_GRAPH, ANSWERS,
    arg("node_name", help="Name of the ROS node"), arg("transition", help="The lifecycle transition"),
)  # fmt: skip
def set_state(args: argparse.Namespace) -> str | None:
    """Trigger it by its name or number; unlike in the real tool, a failure is exit code 1."""
    facts = ChangeFacts(args.transition)
    with joined(args) as me:
        node = me.find(args.node_name, GET_STATE)
        if not node:
            return NOT_FOUND
        me.carry_out(node, change(facts), SERVICES)
    if why := why_not(node, facts, erred=False):
        return f"Transitioning failed: {localized(why)}"
    print("Transitioning successful")
    return None
