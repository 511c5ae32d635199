"""`ros2 component types`: the components that packages have registered in the ament index."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.ros_tools import prefixes

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output a list of components registered in the ament index"
INDEX = Path("share/ament_index/resource_index/rclcpp_components")
"""A file for each package: `namespace::Class;lib/libname.so` a line."""


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", nargs="?", help="Name of the package to list components from")


def main(args: argparse.Namespace) -> str | None:
    """Print them, with the package above if none was named."""
    found = _registered()
    if args.package_name is not None:
        if args.package_name not in found:
            return f"No component types found in package '{args.package_name}'"
        for name in found[args.package_name]:
            print(name)
        return None
    if not found:
        return "No package has registered components: Deck's own nodes are programs, see `ros2 run`"
    for package, names in sorted(found.items()):
        print(package, *(f"  {name}" for name in names), sep="\n")
    return None


def _registered() -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for prefix in map(Path, prefixes(os.environ)):
        folder = prefix / INDEX
        for file in sorted(folder.iterdir()) if folder.is_dir() else ():
            lines = file.read_text(encoding="utf-8", errors="replace").splitlines()
            names = [line.partition(";")[0] for line in lines if line.strip()]
            found.setdefault(file.name, names)
    return found
