"""Past log lines and new ones, joined without gaps or duplicates."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launcher.events import LogEvent

if TYPE_CHECKING:
    from collections.abc import Mapping


def newer(event: LogEvent, known: Mapping[str, int]) -> LogEvent:
    """Return the event without what is known already.

    Args:
        event: lines of nodes that count theirs without a gap, and how many were left out
        known: node to the number of its newest line that is known, with all before it
    """
    lines = tuple(line for line in event.lines if line.seq > known.get(line.node, 0))
    first: dict[str, int] = {}
    for line in lines:
        first.setdefault(line.node, line.seq)
    # Left out were those right before the first; where there is none, all are known.
    missing = {
        node: min(count, first.get(node, 0) - 1 - known[node]) if node in known else count
        for node, count in event.skipped.items()
    }
    return LogEvent(lines, {node: count for node, count in missing.items() if count > 0})
