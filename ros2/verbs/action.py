"""`ros2 action`: lists, types, who serves and uses one, and goals."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

from graph.calls.goals import ENDS, STATUS
from graph.scan import services_of_nodes
from ros2 import naming
from ros2.joining import SPIN_S, joined
from ros2.messages import filled, load, read, to_yaml
from ros2.verb import ANSWERS, OF_GRAPH, TYPES, arg, flag, verb
from text.plain import plain

if TYPE_CHECKING:
    import argparse

    from ros2.joining import Guest

NAME = arg("action_name", help="Name of the ROS action (e.g. '/fibonacci')")

verb(
    "action list", "Output a list of action names", OF_GRAPH, TYPES,
    flag("-c", "--count-actions", dest="count", help="Only display the number of actions"),
)(partial(naming.list_all, "action"))  # fmt: skip
verb(
    "action type", "Print a action's type", OF_GRAPH,
    arg("name", metavar="action_name", help="Name of the ROS action to get type"),
)(partial(naming.print_types, "action"))  # fmt: skip


@verb("action info", "Print information about an action", OF_GRAPH, NAME, TYPES)
def info(args: argparse.Namespace) -> None:
    """Print its clients and servers."""
    with joined(args, settled=True) as me:
        name = naming.expanded(args.action_name, me.node)
        found = services_of_nodes(me.node, me.node.get_fully_qualified_name(), lambda: None)
    print(f"Action: {args.action_name}")
    for what in ("calls", "serves"):
        users = {
            plain(node): types
            for node, one in sorted(found.items())
            if (types := getattr(one, what).actions.get(name))
        }
        print(f"Action {'clients' if what == 'calls' else 'servers'}: {len(users)}")
        for node, types in users.items():
            print(f"    {node} [{plain(', '.join(types))}]" if args.show_types else f"    {node}")


@verb(
    "action send_goal", "Send an action goal", OF_GRAPH, ANSWERS, NAME,
    arg("action_type", help="Type of the ROS action (e.g. 'example_interfaces/action/Fibonacci')"),
    arg("goal", nargs="?", default="{}", help="Goal request values in YAML format (e.g. '{order: 10}')"),
    flag("-f", "--feedback", help="Echo feedback messages for the goal"),
)  # fmt: skip
def send_goal(args: argparse.Namespace) -> None:
    """Send it, and wait for its result; Ctrl-C cancels it."""
    from rclpy.action import ActionClient

    kind = load(args.action_type, "action")
    goal = filled(kind.Goal, read(args.goal)).dated()
    with joined(args) as me:
        client = ActionClient(me.node, kind, args.action_name)
        try:
            _pursue(me, args, client, goal)
        finally:
            client.destroy()


def _pursue(me: Guest, args: argparse.Namespace, client: Any, goal: Any) -> None:  # noqa: ANN401
    print("Waiting for an action server to become available...", flush=True)
    while not client.wait_for_server(timeout_sec=SPIN_S):
        pass
    print(f"Sending goal:\n     {to_yaml(goal)}", flush=True)
    answer = partial(me.answer, owner=f"The action server of {args.action_name}", is_there=client.server_is_ready)
    handle = answer(client.send_goal_async(goal, _print_feedback if args.feedback else None))
    if not handle.accepted:
        print("Goal was rejected.")
        return
    try:
        print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n", flush=True)
        result = answer(handle.get_result_async(), within_s=math.inf)
    except KeyboardInterrupt:
        # Of one that has just been accepted the status may not have come yet.
        if STATUS.get(handle.status) not in ENDS:
            print("Canceling goal...", flush=True)
            if not answer(handle.cancel_goal_async()).goals_canceling:
                raise RuntimeError("Failed to cancel goal") from None
            print("Goal canceled.", flush=True)
        raise
    print(f"Result:\n    {to_yaml(result.result)}")
    ended = STATUS.get(result.status)
    print(f"Goal finished with status: {ended.value.upper() if ended else 'UNKNOWN'}")


def _print_feedback(message: Any) -> None:  # noqa: ANN401 - generated
    print(f"Feedback:\n    {to_yaml(message.feedback)}", flush=True)
