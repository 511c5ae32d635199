"""`ros2 interface list`: all interfaces that are installed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import interfaces

if TYPE_CHECKING:
    import argparse

SUMMARY = "List all interface types available"


def arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("-m", "--only-msgs", action="store_true", help="Print out only the message types")
    add("-s", "--only-srvs", action="store_true", help="Print out only the service types")
    add("-a", "--only-actions", action="store_true", help="Print out only the action types")


def main(args: argparse.Namespace) -> int | str | None:
    """Print them, each kind under a title."""
    wanted = {"msg": args.only_msgs, "srv": args.only_srvs, "action": args.only_actions}
    for kind, title in interfaces.KINDS.items():
        if wanted[kind] or not any(wanted.values()):
            print(f"{title}:")
            print("".join(f"    {name}\n" for name in interfaces.of_kind(kind)), end="")
    return None
