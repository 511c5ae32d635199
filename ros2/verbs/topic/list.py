"""`ros2 topic list`: the topics of the graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import naming, options
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

SUMMARY = "Output a list of available topics"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    add = parser.add_argument
    add("-t", "--show-types", action="store_true", help="Additionally show the topic type")
    add("-c", "--count-topics", action="store_true", help="Only display the number of topics discovered")
    options.hidden_topics(parser)
    add("-v", "--verbose", action="store_true", help="List full details about each topic")


def main(args: argparse.Namespace) -> int | str | None:
    """Print their names, with types or numbers of endpoints if asked."""
    with joined(args, settled=True) as me:
        topics = naming.shown(me.node.get_topic_names_and_types(), hidden=args.include_hidden_topics)
        if args.count_topics:
            print(len(topics))
        elif args.verbose:
            if topics:
                _print_ends(topics, "Published", "publisher", me.node.count_publishers)
                _print_ends(topics, "Subscribed", "subscriber", me.node.count_subscribers)
        else:
            for name, types in topics:
                print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return None


def _print_ends(topics: list[tuple[str, list[str]]], title: str, what: str, count: Callable[[str], int]) -> None:
    print(f"{title} topics:")
    for name, types in topics:
        if ends := naming.count(name, count):
            plural = "s" if ends > 1 else ""
            print(f" * {name} [{', '.join(types)}] {ends} {what}{plural}")
    print()
