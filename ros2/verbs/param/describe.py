"""`ros2 param describe`: type, range and description of parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import options, parameters
from ros2.joining import joined
from text.plain import plain

if TYPE_CHECKING:
    import argparse

SUMMARY = "Show descriptive information about declared parameters"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    options.answers(parser)
    add = parser.add_argument
    add("node_name", help="Name of the ROS node")
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    add("parameter_names", nargs="+", help="Names of the parameters")


def main(args: argparse.Namespace) -> int | str | None:
    """Print what the node has declared."""
    with joined(args) as me:
        node = parameters.find_node(me, args.node_name, hidden=args.include_hidden_nodes)
        if not node:
            return parameters.NOT_FOUND
        response = parameters.call(me, node, "DescribeParameters", names=args.parameter_names)
    for each in response.descriptors:
        print("Parameter name:", plain(each.name))
        print("  Type:", parameters.TYPES[each.type])
        if each.description:
            print("  Description:", each.description)
        print("  Constraints:")
        if each.read_only:
            print("    Read only: true")
        for limits in [*each.floating_point_range, *each.integer_range][:1]:
            print("    Min value:", limits.from_value)
            print("    Max value:", limits.to_value)
            if limits.step:
                print("    Step:", limits.step)
        if each.additional_constraints:
            print("    Additional constraints:", each.additional_constraints)
    return None
