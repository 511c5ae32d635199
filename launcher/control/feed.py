"""What one client already knows, and what it is sent next.

A client is sent the current state, not its whole history: statuses replace each other, and of the
lines since the last batch it gets the newest of each node, with a count of those left out. So a
slow client costs nothing, and one that catches up is up to date at once.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterable, Mapping
from typing import Any

from launcher.events import LogEvent, StatusEvent, pack_event
from launcher.logs.ring import LogRing
from launcher.status import NodeStatus

MAX_LINES = 200
"""Most lines of one node in one batch."""
MAX_CHARS = 64 * 1024
"""Most characters of one node's lines in one batch, not counting its first line."""


class ClientFeed:
    """The updates for one client."""

    def __init__(self, rings: Mapping[str, LogRing]) -> None:
        """Begin with lines that are written from now on; older ones are history."""
        self._rings = rings
        self._seen = {name: ring.last_seq for name, ring in rings.items()}
        self._changed: dict[str, None] = {}

    def status_changed(self, names: Iterable[str]) -> None:
        """Mark the statuses of these nodes to be sent."""
        self._changed.update(dict.fromkeys(names))

    def status_news(self, statuses: Mapping[str, NodeStatus]) -> dict[str, Any] | None:
        """Return the message about changed nodes, None if there are none."""
        if not self._changed:
            return None
        nodes = tuple(statuses[name] for name in self._changed)
        self._changed.clear()
        return pack_event(StatusEvent(nodes))

    def log_news(self) -> dict[str, Any] | None:
        """Return the next batch of lines, None if there are none."""
        news = []
        skipped = {}
        for name, ring in self._rings.items():
            missed = ring.last_seq - self._seen[name]
            if missed:
                lines = ring.after(self._seen[name], MAX_LINES, MAX_CHARS)
                self._seen[name] = ring.last_seq
                news.append(lines)
                if missed > len(lines):
                    skipped[name] = missed - len(lines)
        if not news:
            return None
        # A node's own lines always stay in order, whatever their time stamps say.
        batch = heapq.merge(*news, key=lambda line: line.time_s)
        return pack_event(LogEvent(tuple(batch), skipped))
