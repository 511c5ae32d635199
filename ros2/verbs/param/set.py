"""`ros2 param set`: a new value for a parameter."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import options, parameters

if TYPE_CHECKING:
    import argparse

SUMMARY = "Set parameter"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    options.answers(parser)
    add = parser.add_argument
    add("node_name", help="Name of the ROS node")
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    add("parameter_name", help="Name of the parameter")
    add("value", help="Value of the parameter")


def main(args: argparse.Namespace) -> int | str | None:
    """Set it; that the node refuses it goes to standard error, with the exit code 0."""
    from rcl_interfaces.msg import Parameter

    value = parameters.written_value(args.parameter_name, args.value)
    wanted = Parameter(name=args.parameter_name, value=value)
    done, failed = "Set parameter successful", "Setting parameter failed"
    return parameters.write(args, [wanted], done=done, failed=failed)
