"""What a supervisor says to its clients of itself: a greeting, and then events."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias, get_args

from launcher.consent import Agents
from launcher.status import LogLine, NodeStatus, SessionInfo, Stray
from launcher.wire import VERSION, Sentence, pack, unpack


@dataclass(frozen=True)
class Hello:
    """What it says first: how everything is now."""

    session: SessionInfo
    nodes: tuple[NodeStatus, ...]
    strays: tuple[Stray, ...] = ()
    agents: Agents = field(default_factory=Agents)
    unguarded: bool = False
    """Whether it has lost its guardian."""
    deck: int = VERSION


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

    reason: Sentence


Event: TypeAlias = StatusEvent | LogEvent | StraysEvent | AgentsEvent | UnguardedEvent | ClosedEvent
_KINDS: dict[str, type[Event]] = {kind.__name__.removesuffix("Event").lower(): kind for kind in get_args(Event)}


def pack_event(event: Event) -> dict[str, Any]:
    """Return the message that tells an event."""
    return {"event": type(event).__name__.removesuffix("Event").lower(), **pack(event)}


def unpack_event(message: Mapping[str, Any]) -> Event | None:
    """Return the event of a message; None if it tells none that is known. Raises ValueError."""
    kind = _KINDS.get(message.get("event", ""))
    found: Event | None = None if kind is None else unpack(kind, message)
    return found
