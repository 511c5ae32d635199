"""What topics, services and actions are asked for alike: lists, those of a type, the type of one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import naming
from ros2.joining import joined
from text.plain import plain

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from rclpy.node import Node


def known(kind: str, node: Node) -> list[tuple[str, list[str]]]:
    """Return the names and types in the graph; `kind`: `topic`, `service` or `action`."""
    if kind == "action":
        from rclpy.action import get_action_names_and_types

        return list(get_action_names_and_types(node))
    return list(node.get_topic_names_and_types() if kind == "topic" else node.get_service_names_and_types())


def print_names(names: Sequence[str], *, count: bool) -> None:
    """Print names a line each, or only how many there are."""
    if count:
        print(len(names))
    elif names:
        print(*names, sep="\n")


def listed(kind: str, args: argparse.Namespace) -> None:
    """Print all names, with types if asked."""
    with joined(args, settled=True) as me:
        rows = naming.shown(known(kind, me.node), hidden=getattr(args, "hidden", True))
    lines = [f"{name} [{', '.join(types)}]" if args.show_types else name for name, types in rows]
    print_names(lines, count=args.count)


def found(kind: str, args: argparse.Namespace) -> None:
    """Print the names of those of one type."""
    with joined(args, settled=True) as me:
        rows = naming.shown(known(kind, me.node), hidden=args.hidden)
    print_names([name for name, types in rows if args.type in types], count=args.count)


def types(kind: str, args: argparse.Namespace) -> int | None:
    """Print the types of one; the exit code is 1 if it is not there."""
    with joined(args) as me:
        if not me.await_until(lambda: args.name in dict(known(kind, me.node))):
            return 1
        print(*map(plain, dict(known(kind, me.node)).get(args.name, [])), sep="\n")
    return None
