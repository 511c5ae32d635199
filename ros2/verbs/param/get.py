"""`ros2 param get`: the value of a parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import options, parameters
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Get parameter"


LABELS = (
    "", "Boolean value is:", "Integer value is:", "Double value is:", "String value is:",
    "Byte values are:", "Boolean values are:", "Integer values are:", "Double values are:",
    "String values are:",
)  # fmt: skip
"""By the numbers of rcl_interfaces/msg/ParameterType."""


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    options.answers(parser)
    add = parser.add_argument
    add("node_name", help="Name of the ROS node")
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    add("parameter_name", help="Name of the parameter")
    add("--hide-type", action="store_true", help="Hide the type information")


def main(args: argparse.Namespace) -> int | str | None:
    with joined(args) as me:
        node = parameters.find_node(me, args.node_name, hidden=args.include_hidden_nodes)
        if not node:
            return parameters.NOT_FOUND
        response = parameters.call(me, node, "GetParameters", names=[args.parameter_name])
    if not response.values:
        return "Parameter not set"
    (value,) = response.values
    if value.type >= len(LABELS):
        return f"Unknown parameter type '{value.type}'"
    # As the message has it: an array prints as array('d', ...).
    held = getattr(value, parameters.FIELDS[value.type]) if value.type else None
    if args.hide_type:
        print(held)
    elif held is None:
        print("Parameter not set.")
    else:
        print(LABELS[value.type], held)
    return None
