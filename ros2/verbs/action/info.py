"""`ros2 action info`: who serves an action, and who uses it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import naming, options
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Print information about an action"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    add = parser.add_argument
    add("action_name", help="Name of the ROS action to get info (e.g. '/fibonacci')")
    add("-t", "--show-types", action="store_true", help="Additionally show the action type")
    add("-c", "--count", action="store_true", help="Only display the number of action clients and action servers")


def main(args: argparse.Namespace) -> int | str | None:
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
