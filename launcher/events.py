"""The events that a client of the supervisor receives, one plain class for each kind."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from launcher.consent import Agents
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
    """Node to the number of its lines that this batch leaves out; the log file has them all."""


@dataclass(frozen=True)
class StraysEvent:
    """The processes that an earlier run left behind and that are still there."""

    strays: tuple[Stray, ...]


@dataclass(frozen=True)
class AgentsEvent:
    """The agents, and what they ask for."""

    agents: Agents


@dataclass(frozen=True)
class UnguardedEvent:
    """The supervisor has lost its guardian, which cannot be started again."""


@dataclass(frozen=True)
class ClosedEvent:
    """The session has ended, or the supervisor is gone; no event follows."""

    reason: str


Event: TypeAlias = StatusEvent | LogEvent | StraysEvent | AgentsEvent | UnguardedEvent | ClosedEvent
