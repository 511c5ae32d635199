"""`ros2 interface`: the files that define the types that are installed."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.ros_tools import prefixes
from ros2.verb import arg, flag, verb

if TYPE_CHECKING:
    import argparse

FIELD = re.compile(r"\s*(?P<type>[\w/]+)(?:<=\d+)?(?:\[[^\]]*\])?\s+\w+\s*(?P<rest>.*)")
PRIMITIVES = {"bool", "byte", "char", "float32", "float64", "string", "wstring"} | {
    f"{name}{bits}" for name in ("int", "uint") for bits in (8, 16, 32, 64)
}


@verb(
    "interface show", "Output the interface definition",
    flag("--all-comments", help="Show all comments, including for nested interface definitions"),
    flag("--no-comments", help="Show no comments or whitespace"),
    arg("type", help="Show an interface definition (e.g. 'example_interfaces/msg/String'); '-' reads it from stdin"),
)  # fmt: skip
def show(args: argparse.Namespace) -> str | None:
    """Print it, with the messages in it below where they stand."""
    name = sys.stdin.readline().strip() if args.type == "-" else args.type
    try:
        _show(name, comments=not args.no_comments, nested=args.all_comments, depth=0)
    except (LookupError, ValueError) as error:
        return str(error.args[0])
    return None


def path(name: str) -> Path:
    """Return the file that defines `std_msgs/msg/String`; ValueError or LookupError without."""
    parts = name.split("/")
    if len(parts) != 3 or not all(parts):
        raise ValueError(f"Invalid name '{name}'. Expected three parts separated by '/'")
    package, kind, _ = parts
    homes = [home for prefix in prefixes(os.environ) if (home := Path(prefix, "share")) and (home / package).is_dir()]
    if not homes:
        raise LookupError(f"Unknown package '{package}'")
    file = homes[0] / f"{name}.{kind}"
    if not file.is_file():
        raise LookupError(f"Could not find the interface '{homes[0] / name}'")
    return file


def _show(name: str, *, comments: bool, nested: bool, depth: int) -> None:
    package = name.split("/", maxsplit=1)[0]
    for line in path(name).read_text(encoding="utf-8").splitlines():
        text = line.rstrip()
        field = FIELD.match(line)
        is_constant = field is not None and field["rest"].startswith("=")
        if not comments:
            if not text or text.lstrip().startswith("#"):
                continue
            if not is_constant:
                text = text.partition("#")[0].strip()
        print("\t" * depth + text if text else "")
        if field is not None and not is_constant and field["type"] not in PRIMITIVES:
            owner, _, inner = field["type"].rpartition("/")
            inner = f"{owner.partition('/')[0] or package}/msg/{inner}"
            _show(inner, comments=nested, nested=nested, depth=depth + 1)
