"""`ros2 param load`: the parameters in a file, set one by one."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import options, parameters

if TYPE_CHECKING:
    import argparse

SUMMARY = "Load parameter file for a node"


def arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options."""
    options.of_graph(parser)
    add = parser.add_argument
    add("node_name", help="Name of the ROS node")
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    add("parameter_file", help="Parameter file")
    add(
        "--no-use-wildcard",
        action="store_true",
        help="Do not load parameters in the '/**' namespace into the node",
    )


def main(args: argparse.Namespace) -> int | str | None:
    """Set them, and say of each whether the node took it."""
    from rclpy.parameter import parameter_dict_from_yaml_file

    full = args.node_name if args.node_name.startswith("/") else f"/{args.node_name}"
    try:
        wanted = parameter_dict_from_yaml_file(
            args.parameter_file, use_wildcard=not args.no_use_wildcard, target_nodes=[full]
        )
    except (OSError, RuntimeError, ValueError) as error:
        return str(error)
    done, failed = "Set parameter {name} successful", "Set parameter {name} failed"
    return parameters.write(args, list(wanted.values()), done=done, failed=failed)
