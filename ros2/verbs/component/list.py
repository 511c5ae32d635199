"""`ros2 component list`: containers, and the components in each."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import options
from ros2.joining import joined
from ros2.naming import absolute, servers
from text.plain import plain

if TYPE_CHECKING:
    import argparse

    from ros2.joining import Guest

SUMMARY = "Output a list of running containers and components"
LIST_NODES = "/_container/list_nodes"
LIST_NODES_TYPE = "composition_interfaces/srv/ListNodes"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    options.answers(parser)
    add = parser.add_argument
    add("container_node_name", nargs="?", help="Name of the container node to list components from")
    add("--containers-only", action="store_true", help="List found containers nodes only")


def main(args: argparse.Namespace) -> int | str | None:
    """Print them; those of one container without its name."""
    one = args.container_node_name
    with joined(args, settled=one is None) as me:
        if one is not None:
            full = absolute(one)
            if not me.await_until(lambda: full in _containers(me)):
                return f"Unable to find container node '{one}'"
            if not args.containers_only:
                _print_components(me, full, "")
            return None
        for container in _containers(me):
            print(container)
            if not args.containers_only:
                _print_components(me, container, "  ")
    return None


def _containers(me: Guest) -> list[str]:
    return servers(me.node, LIST_NODES, LIST_NODES_TYPE, hidden=True)


def _print_components(me: Guest, container: str, indent: str) -> None:
    try:
        from composition_interfaces.srv import ListNodes
    except ImportError as error:
        raise RuntimeError(f"The type {LIST_NODES_TYPE} is not installed") from error
    answer = me.call(f"{container}{LIST_NODES}", ListNodes, container)
    for number, name in zip(answer.unique_ids, answer.full_node_names, strict=True):
        print(f"{indent}{number}  {plain(name)}")
