"""`ros2 action list`: the actions of the graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import naming, options
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output a list of action names"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    add = parser.add_argument
    add("-t", "--show-types", action="store_true", help="Additionally show the action type")
    add("-c", "--count-actions", action="store_true", help="Only display the number of actions")


def main(args: argparse.Namespace) -> int | str | None:
    """Print their names, with types if asked."""
    from rclpy.action import get_action_names_and_types

    with joined(args, settled=True) as me:
        found = naming.shown(get_action_names_and_types(me.node), hidden=True)
    if args.count_actions:
        print(len(found))
        return None
    for name, types in found:
        print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return None
