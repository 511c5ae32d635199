"""`ros2 lifecycle get`: the state of one node, or of all that have one."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from ros2 import lifecycle, options
from ros2.joining import joined
from text.plain import plain

if TYPE_CHECKING:
    import argparse

    from ros2.joining import Guest

SUMMARY = "Get lifecycle state for one or more nodes"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    options.answers(parser)
    add = parser.add_argument
    add(
        "node_name", nargs="?", help="Name of the ROS node. If no name is provided, then get the state for all nodes."
    )
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")


def main(args: argparse.Namespace) -> int | str | None:
    """Print it; a node that does not answer makes the exit code 1, after all others."""
    hidden = args.include_hidden_nodes
    with joined(args, settled=not args.node_name) as me:
        if args.node_name:
            node = lifecycle.find(me, args.node_name, hidden=hidden)
            if not node:
                return lifecycle.NOT_FOUND
            state = lifecycle.state(me, node)
            print(f"{plain(state.label)} [{state.id}]")
            return None
        told = [_print_state(me, node) for node in lifecycle.nodes(me, hidden=hidden)]
    return 0 if all(told) else 1


def _print_state(me: Guest, node: str) -> bool:
    try:
        state = lifecycle.state(me, node)
    except RuntimeError as error:
        print(error, file=sys.stderr)
        return False
    print(f"{node}: {plain(state.label)} [{state.id}]")
    return True
