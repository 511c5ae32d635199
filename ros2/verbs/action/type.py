"""`ros2 action type`: the type of an action."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import options
from ros2.joining import joined
from text.plain import plain

if TYPE_CHECKING:
    import argparse

SUMMARY = "Print a action's type"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    parser.add_argument("action_name", help="Name of the ROS action to get type")


def main(args: argparse.Namespace) -> int | str | None:
    """Print it; the exit code is 1 if there is no such action."""
    from rclpy.action import get_action_names_and_types

    with joined(args, settled=True) as me:
        types = dict(get_action_names_and_types(me.node)).get(args.action_name, [])
    if not types:
        return 1
    print(*map(plain, types), sep="\n")
    return None
