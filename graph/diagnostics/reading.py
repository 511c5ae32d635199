"""Messages of diagnostic_msgs/DiagnosticArray read into plain data, whoever has made them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any

from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

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
