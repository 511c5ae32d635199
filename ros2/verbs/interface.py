"""`ros2 interface`: the types that are installed, and the files that define them."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from ros2.verb import arg, either, flag, verb

if TYPE_CHECKING:
    import argparse

KINDS = {"msg": "Messages", "srv": "Services", "action": "Actions"}


INDEX = Path("share/ament_index/resource_index")
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


def _prefixes() -> list[Path]:
    """Return the places in which packages are installed, by rank."""
    named = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return [Path(each) for each in (*named, sys.prefix) if each]


def packages() -> dict[str, list[str]]:
    """Return each package that has interfaces, and their names: `msg/String`."""
    found: dict[str, list[str]] = {}
    for prefix in _prefixes():
        folder = prefix / INDEX / "rosidl_interfaces"
        for file in sorted(folder.iterdir()) if folder.is_dir() else ():
            if file.name not in found:
                found[file.name] = _names(file.read_text())
    return dict(sorted(found.items()))


def _names(index: str) -> list[str]:
    files = [line.partition(".") for line in index.splitlines()]
    return sorted({name for name, _, kind in files if kind in (*KINDS, "idl") and "/" in name})


@verb(
    "interface list", "List all interface types available",
    *(
        flag(f"-{kind[0]}", f"--only-{kind}s", dest=kind, help=f"Print out only the {words} types")
        for kind, words in (("msg", "message"), ("srv", "service"), ("action", "action"))
    ),
)  # fmt: skip
def list_types(args: argparse.Namespace) -> None:
    """Print them, each kind under a title."""
    wanted = [kind for kind in KINDS if getattr(args, kind)] or [*KINDS]
    for kind in wanted:
        print(f"{KINDS[kind]}:")
        for package, names in packages().items():
            print("".join(f"    {package}/{name}\n" for name in names if name.startswith(f"{kind}/")), end="")


@verb(
    "interface show", "Output the interface definition",
    either(
        flag("--all-comments", help="Show all comments, including for nested interface definitions"),
        flag("--no-comments", help="Show no comments or whitespace"),
    ),
    arg(
        "type",
        help="Show an interface definition (e.g. 'example_interfaces/msg/String'). Passing '-' "
        "reads the argument from stdin (e.g. 'ros2 topic type /chatter | ros2 interface show -').",
    ),
)  # fmt: skip
def show(args: argparse.Namespace) -> int | str | None:
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
    if len(parts) != 3:
        raise ValueError(f"Invalid name '{name}'. Expected three parts separated by '/'")
    if not all(parts):
        raise ValueError(f"Invalid name '{name}'. Must not contain empty parts")
    package, kind, _ = parts
    homes = [prefix for prefix in _prefixes() if (prefix / "share" / package).is_dir()]
    if not homes:
        raise LookupError(f"Unknown package '{package}'")
    file = homes[0] / "share" / f"{name}.{kind}"
    if not file.is_file():
        raise LookupError(f"Could not find the interface '{homes[0] / 'share' / name}'")
    return file


def _show(name: str, *, comments: bool, nested: bool, depth: int) -> None:
    package = name.split("/", maxsplit=1)[0]
    for line in path(name).read_text(encoding="utf-8").splitlines():
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
