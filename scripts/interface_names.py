"""Names in interfaces/ that ROS does not allow: CMake would say so in 35 lines.

Source: https://design.ros2.org/articles/interface_definition.html, "Naming of fields" and others.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

KINDS = ("msg", "srv", "action")
WORDS = "small letters, digits and single _, a letter first, no _ last"
RULES = {
    "package": (re.compile(r"[a-z](?:_?[a-z0-9]+)*"), WORDS),
    "field": (re.compile(r"[a-z](?:_?[a-z0-9]+)*"), WORDS),
    "constant": (re.compile(r"[A-Z](?:_?[A-Z0-9]+)*"), WORDS.replace("small letters", "capitals")),
    "type": (re.compile(r"[A-Z][A-Za-z0-9]*"), "letters and digits, a capital first"),
}
"""What has a name, which names it may have, and this in words."""
_LINE = re.compile(r"\s*[A-Za-z][\w/]*(?:<=\d+)?(?:\[[<=\d]*\])?\s+(?P<name>[^\s=]+)\s*(?P<is>=)?")
"""A field or a constant: type, name, and the sign of a constant."""


def wrong_names(folder: Path) -> list[str]:
    """Return a line, with its place, for each wrong name in the packages of a folder."""
    found: list[str] = []
    for manifest in sorted(folder.glob("*/package.xml")):
        package = manifest.parent
        found += _wrong("package", package.name, _shown(package, folder))
        for kind in KINDS:
            for file in sorted((package / kind).glob(f"*.{kind}")):
                found += _in_file(file, _shown(file, folder))
    return found


def _in_file(file: Path, shown: str) -> Iterator[str]:
    yield from _wrong("type", file.stem, shown)
    lines = file.read_text(encoding="utf-8", errors="replace").splitlines()
    for number, line in enumerate(lines, 1):
        found = _LINE.match(line.partition("#")[0])
        if found is not None:
            what = "constant" if found["is"] else "field"
            yield from _wrong(what, found["name"], f"{shown}:{number}")


def _shown(path: Path, folder: Path) -> str:
    return str(path.relative_to(folder.parent))


def _wrong(what: str, name: str, place: str) -> list[str]:
    """Return what is wrong with a name, and which one may be meant; nothing if it is right."""
    rule, words = RULES[what]
    if rule.fullmatch(name):
        return []
    mended = _mended(name, what)
    meant = f": {mended}" if rule.fullmatch(mended) else ""
    return [f"{place}: {name!r}: the name of a {what} has {words}{meant}"]


def _mended(name: str, what: str) -> str:
    if what == "type":
        return "".join(part[:1].upper() + part[1:] for part in re.split(r"[_-]+", name))
    if what == "constant":
        return re.sub(r"[_-]+", "_", name.upper()).strip("_")
    parted = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name)
    return re.sub(r"[_-]+", "_", parted.lower()).strip("_")
