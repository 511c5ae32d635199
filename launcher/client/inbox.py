"""Events from the supervisor that have not been read yet: merged, and therefore bounded."""

from __future__ import annotations

import asyncio
from collections import deque
from typing import TYPE_CHECKING

from launcher.events import AgentsEvent, ClosedEvent, LogEvent, StatusEvent, StraysEvent, UnguardedEvent

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Iterable, Mapping

    from launcher.consent import Agents
    from launcher.events import Event
    from launcher.status import LogLine, NodeStatus, Stray

MAX_LINES = 10_000
"""Most lines kept unread; beyond that the oldest are dropped and counted as skipped."""


class Inbox:
    """Filled as events arrive, emptied when they are read."""

    def __init__(self) -> None:
        self._nodes: dict[str, NodeStatus] = {}
        self._lines: deque[LogLine] = deque()
        self._skipped: dict[str, int] = {}
        self._strays: tuple[Stray, ...] | None = None
        self._agents: Agents | None = None
        self._unguarded = False
        self._closed: ClosedEvent | None = None
        self._filled = asyncio.Event()

    def put_nodes(self, nodes: Iterable[NodeStatus]) -> None:
        """Add statuses; a newer one replaces the older one of the same node."""
        self._nodes.update((node.name, node) for node in nodes)
        self._filled.set()

    def put_lines(self, lines: Iterable[LogLine], skipped: Mapping[str, int]) -> None:
        """Add log lines, and the number of lines per node that were left out before them."""
        for name, count in skipped.items():
            self._skip(name, count)
        self._lines.extend(lines)
        while len(self._lines) > MAX_LINES:
            self._skip(self._lines.popleft().node, 1)
        self._filled.set()

    def put_strays(self, strays: tuple[Stray, ...]) -> None:
        self._strays = strays
        self._filled.set()

    def put_agents(self, agents: Agents) -> None:
        self._agents = agents
        self._filled.set()

    def put_unguarded(self) -> None:
        """Add that the guardian is lost."""
        self._unguarded = True
        self._filled.set()

    def close(self, reason: str) -> None:
        """Mark the end: nothing follows. Of several reasons the first counts."""
        if self._closed is None:
            self._closed = ClosedEvent(reason)
        self._filled.set()

    async def events(self) -> AsyncIterator[Event]:
        """Yield what has arrived, and wait for more, until the inbox is closed."""
        while True:
            await self._filled.wait()
            self._filled.clear()
            for event in self._take():
                yield event
            if self._closed is not None and not self._filled.is_set():
                self._filled.set()
                yield self._closed
                return

    def _take(self) -> list[Event]:
        events: list[Event] = []
        if self._nodes:
            events.append(StatusEvent(tuple(self._nodes.values())))
        if self._lines or self._skipped:
            events.append(LogEvent(tuple(self._lines), self._skipped))
        if self._strays is not None:
            events.append(StraysEvent(self._strays))
        if self._agents is not None:
            events.append(AgentsEvent(self._agents))
        if self._unguarded:
            events.append(UnguardedEvent())
        self._nodes, self._lines, self._skipped = {}, deque(), {}
        self._strays = self._agents = None
        self._unguarded = False
        return events

    def _skip(self, name: str, count: int) -> None:
        self._skipped[name] = self._skipped.get(name, 0) + count
