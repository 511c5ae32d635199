"""What a client of the supervisor receives: one plain class per kind of event."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from launcher.status import LogLine, NodeStatus, Stray


@dataclass(frozen=True)
class StatusEvent:
    """Nodes whose status has changed."""

    nodes: tuple[NodeStatus, ...]


@dataclass(frozen=True)
class LogEvent:
    """A batch of lines, bounded for each node."""

    lines: tuple[LogLine, ...]
    skipped: Mapping[str, int] = field(default_factory=dict)
    """Node to how many of its lines this batch left out; the log file has them all."""


@dataclass(frozen=True)
class StraysEvent:
    """What an earlier run left behind, as of now."""

    strays: tuple[Stray, ...]


@dataclass(frozen=True)
class ClosedEvent:
    """The session has ended, or the supervisor is gone; nothing comes after."""

    reason: str


Event: TypeAlias = StatusEvent | LogEvent | StraysEvent | ClosedEvent
