"""Past log lines and new ones, joined without gaps or duplicates."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launcher.events import LogEvent

if TYPE_CHECKING:
    from collections.abc import Mapping


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
