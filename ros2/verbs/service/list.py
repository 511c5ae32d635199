"""`ros2 service list`: the services of the graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import naming, options
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output a list of available services"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    add = parser.add_argument
    add("-t", "--show-types", action="store_true", help="Additionally show the service type")
    add("-c", "--count-services", action="store_true", help="Only display the number of services discovered")
    add("--include-hidden-services", action="store_true", help="Consider hidden services as well")


def main(args: argparse.Namespace) -> int | str | None:
    """Print their names, with types if asked."""
    with joined(args, settled=True) as me:
        services = naming.shown(me.node.get_service_names_and_types(), hidden=args.include_hidden_services)
    if args.count_services:
        print(len(services))
        return None
    for name, types in services:
        print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return None
