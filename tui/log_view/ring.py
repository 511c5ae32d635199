"""The lines that a log view keeps: limited in number and bytes, fair to quiet nodes.

When there are too many, the nodes that wrote most lose their oldest lines; a flood from one node
does not push out the lines of others. While somebody reads (`hold`), none of the lines present are
dropped: instead newer lines are, and a mark takes their place.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from launcher.status import LogLine, Severity
from text.i18n import localized
from text.plain import plain
from tui.session.past import KEPT_LINES

LONGEST_TEXT = 16_384
"""Characters kept of one line; the file has the whole line."""
SLACK = 1.25
"""Dropping goes through all lines, so it is done only occasionally, for many at once."""
_OBJECT_BYTES = 130

SAID_BY_DECK = frozenset({"deck", "agent"})
"""The `source` of lines that can be translated."""


@dataclass(slots=True)
class LogEntry:
    """A line, or a mark for missing lines."""

    id: int
    """Increases in order of arrival."""
    node: str
    rank: int
    """Rank of the severity."""
    time_s: float
    text: str
    """The text without control characters."""
    skipped: int = 0
    """Number of missing lines for a mark; 0 for a line."""

    @property
    def size(self) -> int:
        return sys.getsizeof(self.text) + _OBJECT_BYTES


class LineRing:
    """Lines in order of arrival."""

    def __init__(self, max_lines: int = KEPT_LINES, max_bytes: int = 16 * 2**20) -> None:
        """Keep at most this many lines and bytes, and temporarily a quarter more."""
        self.max_lines, self.max_bytes = max_lines, max_bytes
        self.entries: list[LogEntry] = []
        self.counts: dict[str, list[int]] = {}
        """Lines received so far, by node and rank of the severity; missing ones do not count."""
        self._next_id = 0
        self._held = 0
        self._bytes = 0
        self._last_seq: dict[str, int] = {}

    def append(self, lines: Sequence[LogLine], skipped: Mapping[str, int]) -> list[LogEntry]:
        """Add lines; return them with marks where `seq` or `skipped` shows that any are missing."""
        start = len(self.entries)
        seen: Counter[str] = Counter()
        for line in lines:
            node, seq = line.node, line.seq
            last = self._last_seq.get(node)
            if last is not None and seq > last + 1:
                seen[node] += seq - last - 1
                self._add(node, line.time_s, skipped=seq - last - 1)
            self._last_seq[node] = seq
            rank = line.severity.rank
            self.counts.setdefault(node, [0] * len(Severity))[rank] += 1
            text = localized(line.text) if line.source in SAID_BY_DECK else line.text
            self._add(node, line.time_s, rank, text)
        for node, count in skipped.items():
            missing = count - seen[node]
            if missing > 0:
                if node in self._last_seq:
                    self._last_seq[node] += missing
                now_s = self.entries[-1].time_s if self.entries else 0.0
                self._add(node, now_s, skipped=missing)
        return self.entries[start:]

    def _add(self, node: str, time_s: float, rank: int = 0, text: str = "", skipped: int = 0) -> None:
        if len(text) > LONGEST_TEXT:
            text = f"{text[:LONGEST_TEXT]} … (+{len(text) - LONGEST_TEXT})"
        text = plain(text)
        self.entries.append(LogEntry(self._next_id, node, rank, time_s, text, skipped))
        self._next_id += 1
        self._bytes += self.entries[-1].size

    def clear(self) -> None:
        self.entries.clear()
        self.counts.clear()
        self._last_seq.clear()
        self._held = self._bytes = 0

    def hold(self) -> None:
        """Keep all lines that are present now."""
        self._held = len(self.entries)
        self._bytes = 0

    def release(self) -> None:
        """Allow the oldest lines to be dropped again."""
        self._held = 0
        self._bytes = sum(entry.size for entry in self.entries)

    @property
    def full(self) -> bool:
        """Whether it is time to call `trim`."""
        loose = len(self.entries) - self._held
        return loose > self.max_lines * SLACK or self._bytes > self.max_bytes * SLACK

    def trim(self) -> None:
        """Drop lines of the nodes that wrote most until the limits hold; marks stand for what is held up."""
        loose = self.entries[self._held :]
        sizes: Counter[str] = Counter()
        for entry in loose:
            sizes[entry.node] += entry.size
        over_lines = _surplus(Counter(entry.node for entry in loose), self.max_lines)
        over_bytes = _surplus(sizes, self.max_bytes)
        gaps: Counter[str] = Counter()
        kept: list[LogEntry] = []
        for entry in loose:
            node = entry.node
            if over_lines[node] <= 0 and over_bytes[node] <= 0:
                kept.append(entry)
                continue
            over_lines[node] -= 1
            over_bytes[node] -= entry.size
            gaps[node] += entry.skipped or 1
            if self._held and over_lines[node] <= 0 and over_bytes[node] <= 0:
                kept.append(LogEntry(entry.id, node, 0, entry.time_s, "", gaps[node]))
        self.entries[self._held :] = kept
        self._bytes = sum(entry.size for entry in kept)


def _surplus(amounts: Mapping[str, int], budget: int) -> Counter[str]:
    """How much each exceeds its share: the highest level whose sum of min(amount, level) stays within the budget."""
    level, rest = sys.maxsize, sorted(amounts.values())
    while rest:
        share = budget // len(rest)
        if rest[0] > share:
            level = share
            break
        budget -= rest.pop(0)
    return Counter({name: amount - level for name, amount in amounts.items() if amount > level})
