"""/diagnostics of everybody: each status with the history of its level, as a tree by its name."""

from __future__ import annotations

import re
from collections import deque
from dataclasses import dataclass, field
from enum import IntEnum
from typing import TYPE_CHECKING, Any, NamedTuple

from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from graph.data import Sample


MOST_VALUES = 64
LONGEST = 400
"""Characters of a text that are kept."""


class StatusLevel(IntEnum):
    """The levels of diagnostic_msgs/DiagnosticStatus."""

    OK = 0
    WARN = 1
    ERROR = 2
    STALE = 3

    @property
    def rank(self) -> int:
        """Sort by this: the worst is the least."""
        return _RANKS[self]


_RANKS = {
    level: rank for rank, level in enumerate((StatusLevel.ERROR, StatusLevel.WARN, StatusLevel.STALE, StatusLevel.OK))
}


@dataclass(frozen=True)
class DiagnosticStatus:
    """The last that somebody has said of one thing."""

    name: str
    level: StatusLevel
    """One that does not exist is an error."""
    message: str
    hardware: str
    values: Mapping[str, str]
    heard_s: float
    """Unix time."""


def statuses(sample: Sample) -> Iterator[DiagnosticStatus]:
    """Yield what a message says, in printable text; what is malformed is left out."""
    told: Any = sample.value.get("status")
    heard_s = sample.received_s - sample.age_s
    for status in told if isinstance(told, list) else ():
        read = _status(status, heard_s)
        if read is not None:
            yield read


def _status(status: Any, heard_s: float) -> DiagnosticStatus | None:  # noqa: ANN401 - of any make
    try:
        name, level = _text(status["name"]), int(status["level"])
        values = {_text(item["key"]): _text(item["value"]) for item in status["values"][:MOST_VALUES]}
        said, hardware = _text(status["message"]), _text(status["hardware_id"])
    except (KeyError, OverflowError, TypeError, ValueError):
        return None
    known = StatusLevel(level) if level in StatusLevel.__members__.values() else StatusLevel.ERROR
    return DiagnosticStatus(name or "?", known, said, hardware, values, heard_s)


def _text(value: object) -> str:
    return plain(str(value), LONGEST)


STALE_S = 5.0
"""A status that was not repeated for so long is stale: diagnostics are published each second.

Source: rqt_robot_monitor, which calls a message stale after five seconds.
"""
MOST = 5000
"""Statuses that are kept; more are only counted."""
HISTORY = 50
"""Changes of level that are kept of each."""


class LevelChange(NamedTuple):
    """From when on a status had a level, and what it said then."""

    at_s: float
    """Unix time."""
    level: StatusLevel
    message: str


@dataclass
class StatusRecord:
    """One status and its history."""

    status: DiagnosticStatus
    level: StatusLevel
    """As it is now: stale if it was not repeated."""
    history: deque[LevelChange]
    """The oldest first."""


class DiagnosticsBook:
    """The newest status of each name."""

    def __init__(self) -> None:
        self.left_out = 0
        """How many statuses were not kept, since there are too many."""
        self.revision = 0
        """Changes whenever anything else does."""
        self._records: dict[str, StatusRecord] = {}
        self._excused_s = 0.0

    @property
    def records(self) -> Sequence[StatusRecord]:
        """All of them, in the order in which they were first heard."""
        return tuple(self._records.values())

    def get(self, name: str) -> StatusRecord | None:
        return self._records.get(name)

    def clear(self) -> None:
        self._records.clear()
        self.left_out = 0
        self.revision += 1

    def excuse(self, now_s: float) -> None:
        """Do not count the time before `now_s` (unix) as silence: nobody was listening."""
        self._excused_s = now_s

    def heard_s(self, record: StatusRecord) -> float:
        """Return from when on a status has been silent, unix time."""
        return max(record.status.heard_s, self._excused_s)

    def take(self, samples: Iterable[Sample]) -> None:
        """Read messages of diagnostic_msgs/DiagnosticArray; malformed ones are left out."""
        for sample in samples:
            for status in statuses(sample):
                self._take(status)

    def look(self, now_s: float) -> None:
        """Find what has become stale by `now_s`, unix time."""
        for record in self._records.values():
            if now_s - self.heard_s(record) > STALE_S and record.level is not StatusLevel.STALE:
                self.revision += 1
                _set(record, StatusLevel.STALE, now_s)

    def _take(self, status: DiagnosticStatus) -> None:
        self.revision += 1
        record = self._records.get(status.name)
        if record is None:
            if len(self._records) >= MOST:
                self.left_out += 1
                return
            first = LevelChange(status.heard_s, status.level, status.message)
            self._records[status.name] = StatusRecord(status, status.level, deque([first], maxlen=HISTORY))
            return
        record.status = status
        if record.level is not status.level:
            _set(record, status.level, status.heard_s)


def _set(record: StatusRecord, level: StatusLevel, at_s: float) -> None:
    record.level = level
    record.history.append(LevelChange(at_s, level, record.status.message))


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
