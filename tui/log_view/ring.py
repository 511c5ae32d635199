"""The lines that a log view keeps: bounded in number and bytes, fair to quiet nodes.

When there are too many, the nodes that wrote most lose their oldest lines; a flood of one node
does not push out the lines of the others. While somebody reads (`hold`), nothing that he has
before him is dropped: then the lines that came since are the ones that must go, and a mark tells.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from launcher.status import LogLine, Severity
from text.i18n import said
from text.plain import plain

LONGEST_TEXT = 16_384
"""Characters of one line that are kept; the file has the whole line."""
SLACK = 1.25
"""Dropping goes through all lines, so it is done now and then, for many at once."""
_OBJECT_BYTES = 160


@dataclass(slots=True)
class LogEntry:
    """A line, or a mark that lines are missing here."""

    id: int
    """Counts up in the order of arrival."""
    node: str
    rank: int
    """Rank of the severity."""
    time_s: float
    text: str
    """Harmless: no control characters."""
    skipped: int = 0
    """For a mark: how many lines are missing; 0 for a line."""
    size: int = _OBJECT_BYTES
    """Bytes that it takes, about."""
    dropped: bool = False


class LineRing:
    """Lines in the order of their arrival."""

    def __init__(self, max_lines: int = 20_000, max_bytes: int = 16 * 2**20) -> None:
        """Keep at most so many lines and bytes, and a quarter more for a while."""
        self.max_lines, self.max_bytes = max_lines, max_bytes
        self.entries: list[LogEntry] = []
        self.counts: dict[str, list[int]] = {}
        """Lines that ever came, by node and rank of the severity; missing ones do not count."""
        self._next_id = 0
        self._held = 0
        self._bytes = 0
        self._last_seq: dict[str, int] = {}

    def append(self, lines: Sequence[LogLine], skipped: Mapping[str, int]) -> list[LogEntry]:
        """Take lines in; return them with marks where `seq` or `skipped` tells of missing ones."""
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
            text = line.text if line.source != "deck" else said(line.text)
            self._add(node, line.time_s, rank, text)
        for node, count in skipped.items():
            missing = count - seen[node]
            if missing > 0:
                if node in self._last_seq:
                    self._last_seq[node] += missing
                self._add(node, self._now(), skipped=missing)
        return self.entries[start:]

    def _now(self) -> float:
        return self.entries[-1].time_s if self.entries else 0.0

    def _add(
        self, node: str, time_s: float, rank: int = 0, text: str = "", skipped: int = 0
    ) -> None:
        if len(text) > LONGEST_TEXT:
            text = f"{text[:LONGEST_TEXT]} … (+{len(text) - LONGEST_TEXT})"
        text = plain(text)
        size = sys.getsizeof(text) + _OBJECT_BYTES
        self.entries.append(LogEntry(self._next_id, node, rank, time_s, text, skipped, size))
        self._next_id += 1
        self._bytes += size

    def clear(self) -> None:
        """Forget every line."""
        self.entries.clear()
        self.counts.clear()
        self._last_seq.clear()
        self._held = self._bytes = 0

    def hold(self) -> None:
        """Drop none of the lines that are here now."""
        self._held = len(self.entries)
        self._bytes = 0

    def release(self) -> None:
        """Drop the oldest lines first again."""
        self._held = 0
        self._bytes = sum(entry.size for entry in self.entries)

    @property
    def full(self) -> bool:
        """Whether it is time to `trim`."""
        loose = len(self.entries) - self._held
        return loose > self.max_lines * SLACK or self._bytes > self.max_bytes * SLACK

    def trim(self) -> list[LogEntry]:
        """Drop lines of those who wrote most, until the bounds hold; return new marks for them."""
        loose = self.entries[self._held :]
        lines = Counter(entry.node for entry in loose)
        over_lines = _surplus(lines, self.max_lines)
        sizes: Counter[str] = Counter()
        for entry in loose:
            sizes[entry.node] += entry.size
        over_bytes = _surplus(sizes, self.max_bytes)
        gaps: Counter[str] = Counter()
        kept: list[LogEntry] = []
        marks: list[LogEntry] = []
        for entry in loose:
            node = entry.node
            if over_lines[node] <= 0 and over_bytes[node] <= 0:
                kept.append(entry)
                continue
            over_lines[node] -= 1
            over_bytes[node] -= entry.size
            entry.dropped = True
            gaps[node] += entry.skipped or 1
            if self._held and over_lines[node] <= 0 and over_bytes[node] <= 0:
                marks.append(LogEntry(entry.id, node, 0, entry.time_s, "", gaps[node]))
                kept.append(marks[-1])
        self.entries[self._held :] = kept
        self._bytes = sum(entry.size for entry in kept)
        return marks


def _surplus(amounts: Mapping[str, int], budget: int) -> Counter[str]:
    """How much each has too much, when no one may have more than a common level."""
    level = _level(amounts.values(), budget)
    return Counter({name: amount - level for name, amount in amounts.items() if amount > level})


def _level(amounts: Iterable[int], budget: int) -> int:
    """The highest level for which the sum of min(amount, level) keeps within the budget."""
    rest = sorted(amounts)
    while rest:
        share = budget // len(rest)
        if rest[0] > share:
            return share
        budget -= rest.pop(0)
    return sys.maxsize
