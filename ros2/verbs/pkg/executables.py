"""`ros2 pkg executables`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2.packages import NoPackageError, executables, packages

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

SUMMARY = "Output a list of package specific executables"


def arguments(parser: ArgumentParser) -> None:
    parser.add_argument("package_name", nargs="?", help="The package name")
    parser.add_argument("--full-path", action="store_true", help="Show the full path of each executable")


def main(args: Namespace) -> str | None:
    """Print package and program, or the path of each."""
    names = sorted(packages()) if args.package_name is None else [args.package_name]
    for package in names:
        try:
            paths = sorted(executables(package), key=lambda path: path.name)
        except NoPackageError:
            return f"Package '{package}' not found"
        for path in paths:
            print(path if args.full_path else f"{package} {path.name}")
    return None
