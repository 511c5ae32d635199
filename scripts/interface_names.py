"""Names in interfaces/ that ROS does not allow: CMake would say so in 35 lines.

Source: https://design.ros2.org/articles/interface_definition.html, "Naming of fields" and others.
"""

from __future__ import annotations

import keyword
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
_LINE = re.compile(r"\s*(?P<type>[A-Za-z][\w/]*)(?:<=\d+)?(?:\[[<=\d]*\])?\s+(?P<name>[^\s=]+)\s*(?P<is>=)?")
"""A field or a constant: type, name, and the sign of a constant."""
_NEXT = "---"
"""What begins the next part of a service or an action."""
_TYPES = (
    *("bool", "byte", "char", "float32", "float64", "int8", "uint8", "int16", "uint16", "int32"),
    *("uint32", "int64", "uint64", "string", "wstring"),
)
_MEANT = {
    "boolean": "bool", "double": "float64", "float": "float64", "int": "int32", "long": "int64",
    "short": "int16", "str": "string", "time": "builtin_interfaces/Time", "uint": "uint32",
    "duration": "builtin_interfaces/Duration", "Header": "std_msgs/Header",
}  # fmt: skip
_OF_CPP = (
    "alignas alignof asm auto bool case catch char class const constexpr decltype default delete do"
    " double enum explicit export extern float friend goto inline int long mutable namespace new"
    " noexcept nullptr operator private protected public register short signed sizeof static struct"
    " switch template this throw typedef typeid typename union unsigned using virtual void volatile"
    " while"
)
"""Words of C++, which, like those of Python, name no field."""


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
    known: dict[str, int] = {}
    for number, line in enumerate(lines, 1):
        if line.startswith(_NEXT):
            known = {}
        found = _LINE.match(line.partition("#")[0])
        if found is not None:
            place, name = f"{shown}:{number}", found["name"]
            yield from _wrong("constant" if found["is"] else "field", name, place)
            if name in known:
                yield f"{place}: {name!r} stands here a second time, first in line {known[name]}"
            if keyword.iskeyword(name) or name in _OF_CPP.split():
                yield f"{place}: {name!r} is a word of Python or C++, and cannot name a field"
            known.setdefault(name, number)
            yield from _wrong_type(found["type"], place, file)


def _wrong_type(kind: str, place: str, file: Path) -> list[str]:
    """Return which type is meant by one that ROS does not have, nothing if it may have it."""
    if "/" in kind or kind in _TYPES or (file.parent.parent / "msg" / f"{kind}.msg").is_file():
        return []
    meant = _MEANT.get(kind, kind.lower() if kind.lower() in _TYPES else "")
    if meant:
        return [f"{place}: ROS has no type {kind!r}: {meant}"]
    return [f"{place}: ROS has no type {kind!r}"] if kind[:1].islower() else []


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
