"""Every status that was heard, with the history of its level since somebody began to listen."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from graph.diagnostics.reading import DiagnosticStatus, StatusLevel, statuses

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from graph.data import Sample

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
