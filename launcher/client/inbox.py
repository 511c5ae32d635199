"""Events from the supervisor that have not been read yet: merged, and therefore bounded."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import AsyncIterator, Mapping

from launcher.events import AgentsEvent, ClosedEvent, Event, LogEvent, StatusEvent, StraysEvent, UnguardedEvent
from launcher.status import LogLine, NodeStatus

MAX_LINES = 10_000
"""Most lines kept unread; beyond that the oldest are dropped and counted as skipped."""
_ORDER = (StatusEvent, LogEvent, StraysEvent, AgentsEvent, UnguardedEvent)


class Inbox:
    """Filled as events arrive, emptied when they are read."""

    def __init__(self) -> None:
        self._nodes: dict[str, NodeStatus] = {}
        self._lines: deque[LogLine] = deque()
        self._skipped: dict[str, int] = {}
        self._newest: dict[type[Event], Event] = {}
        """Of the events that replace each other."""
        self._closed: ClosedEvent | None = None
        self._filled = asyncio.Event()

    def put(self, event: Event) -> None:
        """Add an event; after the first `ClosedEvent` nothing follows."""
        if isinstance(event, StatusEvent):
            self._nodes.update((node.name, node) for node in event.nodes)
        elif isinstance(event, LogEvent):
            for name, count in event.skipped.items():
                self._skip(name, count)
            self._lines.extend(event.lines)
            while len(self._lines) > MAX_LINES:
                self._skip(self._lines.popleft().node, 1)
        elif isinstance(event, ClosedEvent):
            self._closed = self._closed or event
        else:
            self._newest[type(event)] = event
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
        if self._nodes:
            self._newest[StatusEvent] = StatusEvent(tuple(self._nodes.values()))
        if self._lines or self._skipped:
            self._newest[LogEvent] = LogEvent(tuple(self._lines), self._skipped)
        events = [self._newest[kind] for kind in _ORDER if kind in self._newest]
        self._nodes, self._lines, self._skipped, self._newest = {}, deque(), {}, {}
        return events

    def _skip(self, name: str, count: int) -> None:
        self._skipped[name] = self._skipped.get(name, 0) + count


def newer(event: LogEvent, known: Mapping[str, int]) -> LogEvent:
    """Return the event without the lines that are already known.

    Args:
        event: lines, numbered without gaps per node, and how many were left out
        known: node to the number of its newest known line; all earlier ones are known too
    """
    lines = tuple(line for line in event.lines if line.seq > known.get(line.node, 0))
    first: dict[str, int] = {}
    for line in lines:
        first.setdefault(line.node, line.seq)
    # The lines left out come right before the first one; if there is none, all are known.
    missing = {
        node: min(count, first.get(node, 0) - 1 - known[node]) if node in known else count
        for node, count in event.skipped.items()
    }
    return LogEvent(lines, {node: count for node, count in missing.items() if count > 0})
