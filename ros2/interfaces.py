"""The interfaces that are installed: their names, and the files that define them."""

from __future__ import annotations

import os
import sys
from pathlib import Path

KINDS = {"msg": "Messages", "srv": "Services", "action": "Actions"}
INDEX = Path("share/ament_index/resource_index")


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


def of_kind(kind: str) -> list[str]:
    """Return the interfaces of a kind, `msg`, `srv` or `action`, with their packages."""
    return [
        f"{package}/{name}" for package, names in packages().items() for name in names if name.startswith(f"{kind}/")
    ]


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
