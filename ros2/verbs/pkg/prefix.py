"""`ros2 pkg prefix`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2.packages import NoPackageError, prefix_of

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

SUMMARY = "Output the prefix path of a package"


def arguments(parser: ArgumentParser) -> None:
    parser.add_argument("package_name", help="The package name")
    parser.add_argument("--share", action="store_true", help="Show share directory for the package prefix")


def main(args: Namespace) -> str | None:
    try:
        prefix = prefix_of(args.package_name)
    except NoPackageError:
        return "Package not found"
    print(prefix / "share" / args.package_name if args.share else prefix)
    return None
