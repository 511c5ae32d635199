"""`ros2 node list`: the nodes of the graph."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from ros2 import naming, options
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output a list of available nodes"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_node_list(parser)


def main(args: argparse.Namespace) -> int | str | None:
    """Print them in order."""
    with joined(args, settled=True) as me:
        names = sorted(naming.nodes(me.node, hidden=args.all))
    if args.count_nodes:
        print(len(names))
    elif names:
        if len(set(names)) < len(names):
            print(
                "WARNING: Be aware that there are nodes in the graph that share an exact name, "
                "which can have unintended side effects.",
                file=sys.stderr,
            )
        print(*names, sep="\n")
    return None
