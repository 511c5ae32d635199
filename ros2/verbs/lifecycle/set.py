"""`ros2 lifecycle set`: has a node make a transition."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import lifecycle, options
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Trigger lifecycle state transition"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    options.answers(parser)
    add = parser.add_argument
    add("node_name", help="Name of the ROS node")
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    add("transition", help="The lifecycle transition")


def main(args: argparse.Namespace) -> int | str | None:
    """Trigger it by its name or number; unlike in the real tool, a failure is exit code 1."""
    with joined(args) as me:
        node = lifecycle.find(me, args.node_name, hidden=args.include_hidden_nodes)
        if not node:
            return lifecycle.NOT_FOUND
        known = [each.transition for each in lifecycle.transitions(me, node)]
        wanted = [each for each in known if args.transition in (each.label, str(each.id))]
        if not wanted:
            lines = "".join(f"\n- {each.label} [{each.id}]" for each in known)
            return f"Unknown transition requested, available ones are:{lines}"
        done = lifecycle.change(me, node, wanted[0])
    if not done:
        return "Transitioning failed"
    print("Transitioning successful")
    return None
