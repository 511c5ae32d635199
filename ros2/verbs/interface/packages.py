"""`ros2 interface packages`: the packages that have interfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import interfaces

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output a list of packages that provide interfaces"


def arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("-m", "--only-msgs", action="store_true", help="Only list packages that have messages")
    add("-s", "--only-srvs", action="store_true", help="Only list packages that have services")
    add("-a", "--only-actions", action="store_true", help="Only list packages that have actions")


def main(args: argparse.Namespace) -> int | str | None:
    wanted = {"msg": args.only_msgs, "srv": args.only_srvs, "action": args.only_actions}
    kinds = tuple(f"{kind}/" for kind in wanted if wanted[kind] or not any(wanted.values()))
    for package, names in interfaces.packages().items():
        if any(name.startswith(kinds) for name in names):
            print(package)
    return None
