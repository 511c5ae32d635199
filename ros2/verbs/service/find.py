"""`ros2 service find`: the services of a type."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import naming, options
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output a list of available services of a given type"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_graph(parser)
    add = parser.add_argument
    add("service_type", help="Name of the ROS service type to filter for")
    add("-c", "--count-services", action="store_true", help="Only display the number found")
    add("--include-hidden-services", action="store_true")


def main(args: argparse.Namespace) -> int | str | None:
    with joined(args, settled=True) as me:
        known = naming.shown(me.node.get_service_names_and_types(), hidden=args.include_hidden_services)
    names = [name for name, types in known if args.service_type in types]
    if args.count_services:
        print(len(names))
    elif names:
        print(*names, sep="\n")
    return None
