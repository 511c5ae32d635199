"""`ros2 action`: lists, types, who serves and uses one, and goals."""

from __future__ import annotations

import math
import sys
from functools import partial
from typing import TYPE_CHECKING, Any

from ros2 import naming, options, rows
from ros2.filling import filled, read
from ros2.joining import SPIN_S, joined
from ros2.printing import to_yaml
from ros2.verb import arg, either, flag, verb

if TYPE_CHECKING:
    import argparse

    from ros2.joining import Guest

STATUS = ("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")
"""By the numbers of action_msgs/msg/GoalStatus."""
ENDED = (4, 5, 6)
TYPES = flag("-t", "--show-types", help="Additionally show the action type")

verb(
    "action list", "Output a list of action names", options.of_graph, TYPES,
    flag("-c", "--count-actions", dest="count", help="Only display the number of actions"),
)(partial(rows.listed, "action"))  # fmt: skip
verb(
    "action type", "Print a action's type", options.of_graph,
    arg("name", metavar="action_name", help="Name of the ROS action to get type"),
)(partial(rows.types, "action"))  # fmt: skip


@verb(
    "action info", "Print information about an action", options.of_graph,
    arg("action_name", help="Name of the ROS action to get info (e.g. '/fibonacci')"), TYPES,
    flag("-c", "--count", help="Only display the number of action clients and action servers"),
)  # fmt: skip
def info(args: argparse.Namespace) -> int | str | None:
    """Print its clients and servers."""
    from rclpy.action import graph
    from rclpy.node import NodeNameNonExistentError

    clients: list[str] = []
    servers: list[str] = []
    with joined(args, settled=True) as me:
        name = naming.expanded(args.action_name, me.node)
        for full in naming.nodes(me.node, hidden=True):
            who = naming.split_name(full)
            for found, ask in (
                (clients, graph.get_action_client_names_and_types_by_node),
                (servers, graph.get_action_server_names_and_types_by_node),
            ):
                try:
                    types = dict(ask(me.node, *who)).get(name)
                except NodeNameNonExistentError:
                    # It left in between.
                    continue
                if types:
                    found.append(f"{full} [{', '.join(types)}]" if args.show_types else full)
    print(f"Action: {args.action_name}")
    for what, found in (("clients", clients), ("servers", servers)):
        print(f"Action {what}: {len(found)}")
        if not args.count:
            print("".join(f"    {each}\n" for each in found), end="")
    return None


@verb(
    "action send_goal", "Send an action goal", options.of_node, options.answers,
    arg("action_name", help="Name of the ROS action (e.g. '/fibonacci')"),
    arg("action_type", help="Type of the ROS action (e.g. 'example_interfaces/action/Fibonacci')"),
    either(
        arg("goal", nargs="?", default="{}", help="Goal request values in YAML format (e.g. '{order: 10}')"),
        flag("--stdin", help="Read goal from standard input"),
    ),
    flag("-f", "--feedback", help="Echo feedback messages for the goal"),
)  # fmt: skip
def send_goal(args: argparse.Namespace) -> int | str | None:
    """Send it, and wait for its result; Ctrl-C cancels it."""
    kind = naming.action_class(args.action_type)
    values = read(sys.stdin.read() if args.stdin else args.goal)
    if values is None:
        return "The passed value needs to be a dictionary in YAML format"
    goal = filled(kind.Goal, values, "message fields").dated()
    with joined(args) as me:
        return _drive(me, args, kind, goal)


def _drive(me: Guest, args: argparse.Namespace, kind: type[Any], goal: Any) -> str | None:  # noqa: ANN401
    from rclpy.action import ActionClient

    client = ActionClient(me.node, kind, args.action_name)
    try:
        print("Waiting for an action server to become available...", flush=True)
        while not client.wait_for_server(timeout_sec=SPIN_S):
            pass
        print(f"Sending goal:\n     {to_yaml(goal)}", flush=True)
        feedback = _print_feedback if args.feedback else None
        sent = client.send_goal_async(goal, feedback)
        server = f"The action server of {args.action_name}"
        me.finish(sent, server, is_there=client.server_is_ready)
        handle = sent.result()
        if handle is None:
            raise RuntimeError(f"Exception while sending goal: {sent.exception()!r}")
        if not handle.accepted:
            print("Goal was rejected.")
            return None
        try:
            print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n", flush=True)
            ended = handle.get_result_async()
            me.finish(ended, server, within_s=math.inf, is_there=client.server_is_ready)
        except KeyboardInterrupt:
            _cancel(me, handle, server)
            raise
        result = ended.result()
        if result is None:
            raise RuntimeError(f"Exception while getting result: {ended.exception()!r}")
        print(f"Result:\n    {to_yaml(result.result)}")
        status = result.status if 0 <= result.status < len(STATUS) else 0
        print(f"Goal finished with status: {STATUS[status]}")
        return None
    finally:
        client.destroy()


def _print_feedback(message: Any) -> None:  # noqa: ANN401 - generated
    print(f"Feedback:\n    {to_yaml(message.feedback)}", flush=True)


def _cancel(me: Guest, handle: Any, server: str) -> None:  # noqa: ANN401 - rclpy has no types
    # Of one that has just been accepted the status may not have come yet.
    if handle.status in ENDED:
        return
    print("Canceling goal...", flush=True)
    future = handle.cancel_goal_async()
    me.finish(future, server)
    response = future.result()
    if response is None:
        raise RuntimeError(f"Exception while canceling goal: {future.exception()!r}")
    if not response.goals_canceling:
        raise RuntimeError("Failed to cancel goal")
    print("Goal canceled.", flush=True)
