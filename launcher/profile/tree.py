"""A profile as a tree that remembers the position of everything in its file.

The tree is immutable and may share branches (YAML's aliases); `plain` turns it into dicts, lists
and scalars for validation, `place_of` finds the place that a validation error speaks of.
"""

from __future__ import annotations

from collections.abc import Mapping as AbstractMapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeAlias

from launcher.errors import ProfileProblem

if TYPE_CHECKING:
    pass

Where: TypeAlias = "tuple[str | int, ...]"
"""Path of a value: `("nodes", "sonar_front", "needs", 0)`."""


@dataclass(frozen=True)
class FilePlace:
    """A position in a file, line and column counted from 1, or 0 and 0 for the file as such."""

    file: str
    line: int = 0
    column: int = 0


@dataclass(frozen=True)
class Scalar:
    """A single value."""

    value: object
    """str, bool, int, float or None."""
    text: str
    """As it is written, without quotes: `1e3`, `yes`, `010`."""
    place: FilePlace
    size: int = 1


@dataclass(frozen=True)
class MappingEntry:
    """A key with its value."""

    key_place: FilePlace
    value: Tree


@dataclass(frozen=True)
class Branch:
    """A mapping, in the order of the file."""

    entries: AbstractMapping[str, MappingEntry]
    place: FilePlace
    size: int = 1
    """How many values it has with all aliases written out."""


@dataclass(frozen=True)
class Listing:
    """A sequence."""

    items: tuple[Tree, ...]
    place: FilePlace
    size: int = 1


Tree: TypeAlias = Scalar | Branch | Listing


@dataclass
class Problems:
    """Collects the problems, so that all are reported at once."""

    found: list[ProfileProblem] = field(default_factory=list)

    def add(self, place: FilePlace, where: Where, message: str, hint: str = "") -> None:
        """Note one problem; the same one twice is one."""
        problem = ProfileProblem(
            place.file, place.line, place.column, field_name(where), message, hint
        )
        if problem not in self.found:
            self.found.append(problem)

    def in_order(self) -> tuple[ProfileProblem, ...]:
        """Return the problems in the order of the files' lines."""
        return tuple(sorted(self.found, key=lambda each: (each.file, each.line, each.column)))


def field_name(where: Where) -> str:
    """Write a path as people do: `nodes.sonar_front.needs[0]`."""
    name = ""
    for part in where:
        name += f"[{part}]" if isinstance(part, int) else f".{part}" if name else part
    return name


def plain(tree: Tree) -> Any:  # noqa: ANN401 - whatever YAML can say
    """Return the tree as dicts, lists and scalars."""
    if isinstance(tree, Branch):
        return {key: plain(entry.value) for key, entry in tree.entries.items()}
    if isinstance(tree, Listing):
        return [plain(item) for item in tree.items]
    return tree.value


def empty(tree: Tree | None) -> bool:
    """Whether nothing stands there, as after `params:` at the end of a line."""
    return tree is None or (isinstance(tree, Scalar) and tree.value is None)


def find(tree: Tree, where: Where) -> Tree | None:
    """Return the value at a path, None if there is none."""
    for part in where:
        if isinstance(tree, Branch) and part in tree.entries:
            tree = tree.entries[str(part)].value
        elif isinstance(tree, Listing) and isinstance(part, int) and part < len(tree.items):
            tree = tree.items[part]
        else:
            return None
    return tree


def place_of(tree: Tree, where: Where, *, key: bool = False) -> FilePlace:
    """Return where a value stands, or with `key` its key; the nearest parent's if it is missing."""
    place = tree.place
    for depth, part in enumerate(where):
        if isinstance(tree, Branch) and part in tree.entries:
            entry = tree.entries[str(part)]
            tree = entry.value
            place = entry.key_place if key and depth == len(where) - 1 else tree.place
        elif isinstance(tree, Listing) and isinstance(part, int) and part < len(tree.items):
            tree = tree.items[part]
            place = tree.place
        else:
            break
    return place
