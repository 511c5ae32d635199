"""`ros2 lifecycle list`: the transitions that a node can make."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import lifecycle, options
from ros2.joining import joined
from text.plain import plain

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output a list of available transitions"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    options.answers(parser)
    add = parser.add_argument
    add("node_name", help="Name of the ROS node")
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    add(
        "-a", "--all", action="store_true", help="Display all existing transitions, not only "
        "those available now"
    )  # fmt: skip


def main(args: argparse.Namespace) -> int | str | None:
    """Print each with where it begins and where it leads."""
    with joined(args) as me:
        node = lifecycle.find(me, args.node_name, hidden=args.include_hidden_nodes)
        if not node:
            return lifecycle.NOT_FOUND
        for each in lifecycle.transitions(me, node, of_all=args.all):
            print(
                f"- {plain(each.transition.label)} [{each.transition.id}]\n"
                f"\tStart: {plain(each.start_state.label)}\n"
                f"\tGoal: {plain(each.goal_state.label)}"
            )
    return None
