"""`ros2 param delete`: a parameter less."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import options, parameters

if TYPE_CHECKING:
    import argparse

SUMMARY = "Delete parameter"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    options.answers(parser)
    add = parser.add_argument
    add("node_name", help="Name of the ROS node")
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    add("parameter_name", help="Name of the parameter")


def main(args: argparse.Namespace) -> int | str | None:
    """Delete it; that the node refuses goes to standard error, with the exit code 0."""
    from rcl_interfaces.msg import Parameter

    wanted = Parameter(name=args.parameter_name)
    done, failed = "Deleted parameter successfully", "Deleting parameter failed"
    return parameters.write(args, [wanted], done=done, failed=failed)
