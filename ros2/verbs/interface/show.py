"""`ros2 interface show`: the definition of an interface."""

from __future__ import annotations

import re
import sys
from typing import TYPE_CHECKING

from ros2 import interfaces

if TYPE_CHECKING:
    import argparse

SUMMARY = "Output the interface definition"


FIELD = re.compile(r"\s*(?P<type>[\w/]+)(?:<=\d+)?(?:\[[^\]]*\])?\s+\w+\s*(?P<rest>.*)")
PRIMITIVES = frozenset(f"{name}{bits}" for name in ("int", "uint") for bits in (8, 16, 32, 64)) | {
    "bool",
    "byte",
    "char",
    "float32",
    "float64",
    "string",
    "wstring",
}


def arguments(parser: argparse.ArgumentParser) -> None:
    comments = parser.add_mutually_exclusive_group()
    comments.add_argument(
        "--all-comments", action="store_true", help="Show all comments, including for nested interface definitions"
    )
    comments.add_argument("--no-comments", action="store_true", help="Show no comments or whitespace")
    parser.add_argument(
        "type",
        help="Show an interface definition (e.g. 'example_interfaces/msg/String'). Passing '-' "
        "reads the argument from stdin (e.g. 'ros2 topic type /chatter | ros2 interface show -').",
    )


def main(args: argparse.Namespace) -> int | str | None:
    """Print it, with the messages in it below where they stand."""
    name = sys.stdin.readline().strip() if args.type == "-" else args.type
    try:
        _show(name, comments=not args.no_comments, nested=args.all_comments, depth=0)
    except (LookupError, ValueError) as error:
        return str(error.args[0])
    return None


def _show(name: str, *, comments: bool, nested: bool, depth: int) -> None:
    package = name.split("/", maxsplit=1)[0]
    for line in interfaces.path(name).read_text(encoding="utf-8").splitlines():
        text, inner = line.rstrip(), _message_in(line, package)
        if not comments:
            if not text or text.lstrip().startswith("#"):
                continue
            if not _is_constant(text):
                text = text.partition("#")[0].strip()
        print("\t" * depth + text if text else "")
        if inner:
            _show(inner, comments=nested, nested=nested, depth=depth + 1)


def _is_constant(text: str) -> bool:
    found = FIELD.match(text)
    return bool(found) and found["rest"].startswith("=")  # type: ignore[index]


def _message_in(text: str, package: str) -> str:
    """Return the type of a field that is a message, empty for any other line."""
    found = FIELD.match(text)
    if not found or found["rest"].startswith("=") or found["type"] in PRIMITIVES:
        return ""
    owner, _, name = found["type"].rpartition("/")
    return f"{owner.partition('/')[0] or package}/msg/{name}"
