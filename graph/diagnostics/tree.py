"""The names of statuses as a tree, each branch as bad as the worst in it, the worst first."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from graph.diagnostics.reading import StatusLevel

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from graph.diagnostics.book import StatusRecord

DEEPEST = 8
"""Levels of the tree; a name with more parts keeps the rest in one piece."""
_SEPARATORS = re.compile(r"\s*[/:][/:\s]*")


@dataclass
class _Branch:
    label: str
    path: tuple[str, ...]
    record: StatusRecord | None = None
    below: dict[str, _Branch] = field(default_factory=dict)
    level: StatusLevel = StatusLevel.OK


class TreeRow(NamedTuple):
    """One line of the tree."""

    path: tuple[str, ...]
    """The parts of the name down to here."""
    label: str
    """The last of them."""
    level: StatusLevel
    """The worst of itself and of everything below."""
    record: StatusRecord | None
    """What was said of exactly this, if anything."""

    @property
    def depth(self) -> int:
        """How far it is indented, from 0."""
        return len(self.path) - 1

    @property
    def key(self) -> str:
        """Tell it apart from all others of one tree."""
        return "/".join(self.path)


def parts(name: str) -> tuple[str, ...]:
    """Return the parts of a name, which are separated by `/` (aggregated) or `:` (node: task).

    Source: diagnostic_aggregator, which joins parts by `/`, and diagnostic_updater, which puts the
    node's name and `: ` before that of a task.
    """
    trimmed = name.strip("/: ")
    return tuple(_SEPARATORS.split(trimmed, maxsplit=DEEPEST - 1)) if trimmed else ("?",)


def tree(records: Iterable[StatusRecord]) -> tuple[TreeRow, ...]:
    """Return the lines of the tree from the top, the worst of each branch first, then by name."""
    root = _Branch("", ())
    for record in records:
        branch = root
        for label in parts(record.status.name):
            path = (*branch.path, label)
            branch = branch.below.setdefault(label, _Branch(label, path))
        branch.record = _worse(branch.record, record)
    _weigh(root)
    return tuple(_rows(root))


def _worse(one: StatusRecord | None, other: StatusRecord) -> StatusRecord:
    """Return the worse of two whose names have the same parts."""
    return other if one is None or other.level.rank < one.level.rank else one


def _weigh(branch: _Branch) -> StatusLevel:
    levels = [_weigh(each) for each in branch.below.values()]
    if branch.record is not None:
        levels.append(branch.record.level)
    branch.level = min(levels, key=lambda level: level.rank, default=StatusLevel.OK)
    return branch.level


def _rows(branch: _Branch) -> Iterator[TreeRow]:
    for each in sorted(branch.below.values(), key=lambda one: (one.level.rank, one.label)):
        yield TreeRow(each.path, each.label, each.level, each.record)
        yield from _rows(each)
