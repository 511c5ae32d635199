"""`ros2 lifecycle nodes`: the nodes that have a lifecycle."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import lifecycle, options
from ros2.joining import joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output a list of nodes with lifecycle"


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_node_list(parser)


def main(args: argparse.Namespace) -> int | str | None:
    """Print them in order."""
    with joined(args, settled=True) as me:
        names = lifecycle.nodes(me, hidden=args.all)
    if args.count_nodes:
        print(len(names))
    elif names:
        print(*names, sep="\n")
    return None
