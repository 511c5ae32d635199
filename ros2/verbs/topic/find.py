"""`ros2 topic find`: the topics of a type."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import naming, options
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output a list of available topics of a given type"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    add = parser.add_argument
    add("topic_type", help="Name of the ROS topic type to filter for")
    add("-c", "--count-topics", action="store_true", help="Only display the number found")
    add("--include-hidden-topics", action="store_true")


def main(args: argparse.Namespace) -> int | str | None:
    with joined(args, settled=True) as me:
        known = naming.shown(me.node.get_topic_names_and_types(), hidden=args.include_hidden_topics)
    names = [name for name, types in known if args.topic_type in types]
    if args.count_topics:
        print(len(names))
    elif names:
        print(*names, sep="\n")
    return None
