"""What is in the graph: names of nodes, topics, services and actions, and lists of them to print."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.housekeeping import is_hidden
from graph.scan import full_name
from ros2.joining import joined
from text.plain import plain

if TYPE_CHECKING:
    import argparse
    from collections.abc import Sequence

    from rclpy.node import Node


def absolute(name: str) -> str:
    """Return the name of a node or a topic, with the slash that may have been left out."""
    return name if name.startswith("/") else f"/{name}"


def split_name(full: str) -> tuple[str, str]:
    """Return name and namespace."""
    namespace, _, name = full.rpartition("/")
    return name, namespace or "/"


def nodes(node: Node, *, hidden: bool) -> list[str]:
    """Return the full names of the nodes, as often as they are there, each for one line."""
    return [
        plain(full_name(name, namespace))
        for name, namespace in node.get_node_names_and_namespaces()
        if hidden or not name.startswith("_")
    ]


def shown(names_and_types: Sequence[tuple[str, list[str]]], *, hidden: bool) -> list[tuple[str, list[str]]]:
    """Return topics or services without those that are hidden, each for one line.

    Whoever is no node of ROS may have any name, with line breaks in it.
    """
    return [
        (plain(name), [plain(each) for each in types])
        for name, types in names_and_types
        if hidden or not is_hidden(name)
    ]


def expanded(topic: str, node: Node) -> str:
    """Return the full name of a topic; RuntimeError if it cannot be one."""
    from rclpy.exceptions import InvalidTopicNameException
    from rclpy.expand_topic_name import expand_topic_name
    from rclpy.validate_full_topic_name import validate_full_topic_name

    try:
        name: str = expand_topic_name(topic, node.get_name(), node.get_namespace())
        validate_full_topic_name(name)
    except (ValueError, InvalidTopicNameException) as error:
        raise RuntimeError(str(error)) from error
    return name


def known(kind: str, node: Node) -> list[tuple[str, list[str]]]:
    """Return the names and types in the graph; `kind`: `topic`, `service` or `action`."""
    if kind == "action":
        from rclpy.action import get_action_names_and_types

        return list(get_action_names_and_types(node))
    return list(node.get_topic_names_and_types() if kind == "topic" else node.get_service_names_and_types())


def types_of(kind: str, name: str, node: Node) -> list[str]:
    """Return the types under which a topic, service or action is in the graph."""
    return dict(known(kind, node)).get(name, [])


def print_names(names: Sequence[str], *, count: bool) -> None:
    """Print names a line each, or only how many there are."""
    if count:
        print(len(names))
    elif names:
        print(*names, sep="\n")


def list_all(kind: str, args: argparse.Namespace) -> None:
    """Print all names, with types if asked."""
    with joined(args, settled=True) as me:
        rows = shown(known(kind, me.node), hidden=getattr(args, "hidden", True))
    lines = [f"{name} [{', '.join(types)}]" if args.show_types else name for name, types in rows]
    print_names(lines, count=args.count)


def print_types(kind: str, args: argparse.Namespace) -> int | None:
    """Print the types of one; the exit code is 1 if it is not there."""
    with joined(args) as me:
        if not me.await_until(lambda: bool(types_of(kind, args.name, me.node))):
            return 1
        print(*map(plain, types_of(kind, args.name, me.node)), sep="\n")
    return None
