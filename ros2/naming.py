"""Names in the graph: which are hidden, full names of nodes, topics with their types."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from graph.housekeeping import is_hidden
from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy.node import Node


def full_name(name: str, namespace: str) -> str:
    """Return the full name of a node."""
    return f"{namespace}{'' if namespace.endswith('/') else '/'}{name}"


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


def servers(node: Node, service: str, type_name: str, *, hidden: bool) -> list[str]:
    """Return the full names of the nodes that serve this, sorted: `/get_state` of each.

    A list of all services would also have those that somebody only calls.
    """
    from rclpy.node import NodeNameNonExistentError

    found = []
    for full in nodes(node, hidden=hidden):
        try:
            served = dict(node.get_service_names_and_types_by_node(*split_name(full)))
        except NodeNameNonExistentError:
            # It left in between.
            continue
        if type_name in served.get(f"{full}{service}", ()):
            found.append(full)
    return sorted(set(found))


def shown(names_and_types: list[tuple[str, list[str]]], *, hidden: bool) -> list[tuple[str, list[str]]]:
    """Return topics or services without those that are hidden, each for one line.

    Whoever is no node of ROS may have any name, with line breaks in it.
    """
    return [
        (plain(name), [plain(each) for each in types])
        for name, types in names_and_types
        if hidden or not is_hidden(name)
    ]


def count(topic: str, counted: Callable[[str], int]) -> int:
    """Return how many ends a topic has, 0 of one whose name rclpy refuses."""
    from rclpy.exceptions import InvalidTopicNameException

    try:
        return counted(topic)
    except (ValueError, InvalidTopicNameException):
        return 0


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


def types_of_topic(topic: str, node: Node) -> list[str]:
    """Return the types under which a topic is in the graph."""
    return next((types for name, types in node.get_topic_names_and_types() if name == topic), [])


def load(type_name: str, kind: str) -> type[Any]:
    """Return the class of a type; `pkg/Name` means `pkg/KIND/Name`."""
    parts = type_name.split("/")
    if len(parts) == 2:
        parts.insert(1, kind)
    if len(parts) != 3 or not all(parts):
        raise ValueError(type_name)
    found: type[Any] = getattr(import_module(".".join(parts[:-1])), parts[-1])
    return found


def _class(type_name: str, kind: str, word: str, *parts: str) -> type[Any]:
    try:
        found = load(type_name, kind)
    except (AttributeError, ImportError, ValueError) as error:
        raise RuntimeError(f"The passed {word} type is invalid") from error
    if not all(hasattr(found, part) for part in parts):
        raise RuntimeError(f"The passed type is not {'an' if word == 'action' else 'a'} {word}")
    return found


def message_class(type_name: str) -> type[Any]:
    """Return the class of a message; RuntimeError if there is none."""
    return _class(type_name, "msg", "message")


def service_class(type_name: str) -> type[Any]:
    """Return the class of a service; RuntimeError if there is none."""
    return _class(type_name, "srv", "service", "Request", "Response")


def action_class(type_name: str) -> type[Any]:
    """Return the class of an action; RuntimeError if there is none."""
    return _class(type_name, "action", "action", "Goal")
