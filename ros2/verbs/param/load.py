"""`ros2 param load`: the parameters in a file, set one by one."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ros2 import options, parameters
from ros2.naming import absolute
from text.i18n import localized

if TYPE_CHECKING:
    import argparse

SUMMARY = "Load parameter file for a node"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    options.answers(parser)
    add = parser.add_argument
    add("node_name", help="Name of the ROS node")
    add("--include-hidden-nodes", action="store_true", help="Consider hidden nodes as well")
    add("parameter_file", help="Parameter file")
    add("--no-use-wildcard", action="store_true", help="Do not load parameters in the '/**' namespace into the node")


def main(args: argparse.Namespace) -> int | str | None:
    """Set them, and say of each whether the node took it."""
    from rcl_interfaces.msg import Parameter

    from graph.calls.parameters_file import load_file
    from text.yaml_faults import YamlError

    file = Path(args.parameter_file)
    try:
        found = load_file(file, absolute(args.node_name), wildcards=not args.no_use_wildcard)
    except OSError as error:
        return str(error)
    except YamlError as error:
        return f"{file}:{error.line}:{error.column}: {localized(error.message)}"
    wanted = [Parameter(name=name, value=parameters.typed_value(name, value)) for name, value in found.items()]
    done, failed = "Set parameter {name} successful", "Set parameter {name} failed"
    return parameters.write(args, wanted, done=done, failed=failed)
