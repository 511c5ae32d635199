"""`ros2 param dump`: all parameters of a node as a file in YAML."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ros2 import options, parameters
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

    from graph.data import ParameterRow

SUMMARY = "Show all of the parameters of a node in a YAML file format"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    options.answers(parser)
    add = parser.add_argument
    add("node_name", help="Name of the ROS node")
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")


def main(args: argparse.Namespace) -> int | str | None:
    """Print the file, which `--ros-args --params-file` takes."""
    import yaml

    from graph.calls.parameters_exchange import read

    rows: list[ParameterRow] = []
    with joined(args) as me:
        node = parameters.find_node(me, args.node_name, hidden=args.include_hidden_nodes)
        if not node:
            return parameters.NOT_FOUND
        parameters.carry_out(me, node, read(rows))
    tree: dict[str, Any] = {}
    for row in rows:
        # What was declared without a value has none that a file could hold.
        if row.value is not None:
            _place(tree, row)
    print(yaml.dump({node: {"ros__parameters": tree}}, default_flow_style=False))
    return None


def _place(tree: dict[str, Any], row: ParameterRow) -> None:
    """Nest a name at its dots, unless a part of it is the name of another parameter."""
    value = list(row.value) if isinstance(row.value, (bytes, bytearray)) else row.value
    *above, last = row.name.split(".")
    place = tree
    for step in above:
        place = place.setdefault(step, {})
        if not isinstance(place, dict):
            tree[row.name] = value
            return
    place[last] = value
