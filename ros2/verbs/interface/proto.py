"""`ros2 interface proto`: a message to fill in."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros2 import naming
from ros2.printing import to_yaml

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output an interface prototype"


def arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("type", help='Show an interface definition (e.g. "std_msgs/msg/String")')
    parser.add_argument("--no-quotes", action="store_true", help="if true output has no outer quotes.")


def main(args: argparse.Namespace) -> int | str | None:
    """Print the message, request or goal with its defaults."""
    try:
        cls = naming.load(args.type, "msg")
    except (AttributeError, ImportError, ValueError):
        return f"The passed type '{args.type}' is invalid"
    part = getattr(cls, "Goal", None) or getattr(cls, "Request", None) or cls
    text = to_yaml(part())
    print(text if args.no_quotes else f'"{text}"')
    return None
