"""`ros2 node info`: what one node publishes, hears, serves and calls."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from ros2 import naming, options
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output information about a node"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    add = parser.add_argument
    add("node_name", help="Node name to request information")
    add("--include-hidden", action="store_true", help="Display hidden topics, services, and actions as well")


def main(args: argparse.Namespace) -> int | str | None:
    """Print its topics, services and actions, each kind under a title."""
    from rclpy.action import graph as actions

    with joined(args, settled=True) as me:
        node, hidden = me.node, args.include_hidden
        full = naming.absolute(args.node_name)
        count = naming.nodes(node, hidden=hidden).count(full)
        if not count:
            return f"Unable to find node '{args.node_name}'"
        if count > 1:
            print(
                f'There are {count} nodes in the graph with the exact name "{full}". '
                "You are seeing information about only one of them.",
                file=sys.stderr,
            )
        name = naming.split_name(full)
        print(full)
        for title, found in (
            ("Subscribers", node.get_subscriber_names_and_types_by_node(*name)),
            ("Publishers", node.get_publisher_names_and_types_by_node(*name)),
            ("Service Servers", node.get_service_names_and_types_by_node(*name)),
            ("Service Clients", node.get_client_names_and_types_by_node(*name)),
            ("Action Servers", actions.get_action_server_names_and_types_by_node(node, *name)),
            ("Action Clients", actions.get_action_client_names_and_types_by_node(node, *name)),
        ):
            print(f"  {title}:")
            shown = naming.shown(found, hidden=hidden)
            print(*[f"    {each}: {', '.join(types)}" for each, types in shown], sep="\n")
    return None
