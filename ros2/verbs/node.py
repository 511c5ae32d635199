"""`ros2 node`: the nodes of the graph, and what one has."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from ros2 import naming
from ros2.joining import joined
from ros2.verb import OF_GRAPH, arg, flag, verb

if TYPE_CHECKING:
    import argparse


@verb(
    "node list", "Output a list of available nodes", OF_GRAPH,
    flag("-a", "--all", help="Display all nodes even hidden ones"),
    flag("-c", "--count-nodes", help="Only display the number of nodes discovered"),
)  # fmt: skip
def list_nodes(args: argparse.Namespace) -> None:
    """Print them in order."""
    with joined(args, settled=True) as me:
        names = sorted(naming.nodes(me.node, hidden=args.all))
    if len(set(names)) < len(names) and not args.count_nodes:
        print(
            "WARNING: Be aware that there are nodes in the graph that share an exact name, "
            "which can have unintended side effects.",
            file=sys.stderr,
        )
    naming.print_names(names, count=args.count_nodes)


@verb(
    "node info", "Output information about a node", OF_GRAPH,
    arg("node_name", help="Node name to request information"),
    flag("--include-hidden", help="Display hidden topics, services, and actions as well"),
)  # fmt: skip
def info(args: argparse.Namespace) -> str | None:
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
