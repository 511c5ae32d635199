"""`ros2 topic type`: the types of a topic."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import options
from ros2.joining import joined
from text.plain import plain

if TYPE_CHECKING:
    import argparse

SUMMARY = "Print a topic's type"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    parser.add_argument("topic_name", help="Name of the ROS topic to get type (e.g. '/x')")
    parser.add_argument("--include-hidden-topics", action="store_true")


def main(args: argparse.Namespace) -> int | str | None:
    """Print them; the exit code is 1 if there is no such topic."""
    with joined(args) as me:
        found: list[str] = []

        def there() -> bool:
            found[:] = dict(me.node.get_topic_names_and_types()).get(args.topic_name, [])
            return bool(found)

        if not me.await_until(there):
            return 1
    print(*map(plain, found), sep="\n")
    return None
