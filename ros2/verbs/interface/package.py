"""`ros2 interface package`: the interfaces of a package."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import interfaces

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output a list of available interface types within one package"


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", help="Name of the ROS package (e.g. 'std_msgs')")


def main(args: argparse.Namespace) -> int | str | None:
    names = interfaces.packages().get(args.package_name)
    if names is None:
        return f"Unknown package '{args.package_name}'"
    print("".join(f"{args.package_name}/{name}\n" for name in names), end="")
    return None
