"""`ros2 param dump`: all parameters of a node as a file in YAML."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ros2 import options, parameters
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Show all of the parameters of a node in a YAML file format"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.of_graph(parser)
    add = parser.add_argument
    add("node_name", help="Name of the ROS node")
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")


def main(args: argparse.Namespace) -> int | str | None:
    """Print the file, which `--ros-args --params-file` takes."""
    import yaml

    tree: dict[str, Any] = {}
    with joined(args) as me:
        node = parameters.find_node(me, args.node_name, hidden=args.include_hidden_nodes)
        if not node:
            return parameters.NOT_FOUND
        listed = parameters.call(me, node, "ListParameters")
        names = sorted(listed.result.names)
        response = parameters.call(me, node, "GetParameters", names=names)
    for name, value in zip(names, response.values, strict=True):
        *above, last = name.split(".")
        place = tree
        for step in above:
            place = place.setdefault(step, {})
        place[last] = parameters.plain(value)
    print(yaml.dump({node: {"ros__parameters": tree}}, default_flow_style=False))
    return None
