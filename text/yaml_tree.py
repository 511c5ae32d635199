"""A YAML text as a tree that remembers the position of everything in it.

The tree is immutable and may share branches (YAML aliases); `plain` turns it into dicts, lists
and single values, `place_of` finds the position that an error message points at.
"""

from __future__ import annotations

from collections.abc import Mapping as AbstractMapping
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple, TypeAlias

Where: TypeAlias = "tuple[str | int, ...]"
"""Path of a value: `("nodes", "sonar_front", "needs", 0)`."""


class FilePlace(NamedTuple):
    """A position in a file; line and column count from 1, or are both 0 for the file as a whole."""

    file: str
    """Its name as messages have it, empty for a text that is in none."""
    line: int = 0
    column: int = 0


@dataclass(frozen=True, slots=True)
class Scalar:
    """A value that is neither mapping nor sequence."""

    value: bool | int | float | str | None
    text: str
    """As written, without quotes: `1e3`, `yes`, `010`."""
    place: FilePlace
    size: ClassVar[int] = 1


class MappingEntry(NamedTuple):
    """A key with its value."""

    key_place: FilePlace
    value: Tree


@dataclass(frozen=True, slots=True)
class Branch:
    """A mapping, in the order of the text."""

    entries: AbstractMapping[str, MappingEntry]
    place: FilePlace
    size: int = 1
    """How many values it contains, with all aliases expanded."""


@dataclass(frozen=True, slots=True)
class Listing:
    """A sequence, in the order of the text."""

    items: tuple[Tree, ...]
    place: FilePlace
    size: int = 1


Tree: TypeAlias = Scalar | Branch | Listing


def field_name(where: Where) -> str:
    """Write a path in the usual form: `nodes.sonar_front.needs[0]`."""
    name = ""
    for part in where:
        name += f"[{part}]" if isinstance(part, int) else f".{part}" if name else part
    return name


def plain(tree: Tree) -> Any:  # noqa: ANN401 - anything YAML can express
    """Return the tree as dicts, lists and single values."""
    if isinstance(tree, Branch):
        return {key: plain(entry.value) for key, entry in tree.entries.items()}
    if isinstance(tree, Listing):
        return [plain(item) for item in tree.items]
    return tree.value


def empty(tree: Tree | None) -> bool:
    """Whether the value is empty, as after `params:` at the end of a line."""
    return tree is None or (isinstance(tree, Scalar) and tree.value is None)


def find(tree: Tree, where: Where) -> Tree | None:
    """Return the value at a path, None if there is none."""
    for part in where:
        entry = _below(tree, part)
        if entry is None:
            return None
        tree = entry.value
    return tree


def place_of(tree: Tree, where: Where, *, key: bool = False) -> FilePlace:
    """Return the place of a value, or with `key` of its key; if missing, of its nearest parent."""
    place = tree.place
    for depth, part in enumerate(where):
        entry = _below(tree, part)
        if entry is None:
            break
        tree = entry.value
        place = entry.key_place if key and depth == len(where) - 1 else tree.place
    return place


def _below(tree: Tree, part: str | int) -> MappingEntry | None:
    """Return what is one step down; an item of a list has its own place in place of a key's."""
    if isinstance(tree, Branch) and part in tree.entries:
        return tree.entries[str(part)]
    if isinstance(tree, Listing) and isinstance(part, int) and part < len(tree.items):
        item = tree.items[part]
        return MappingEntry(item.place, item)
    return None
