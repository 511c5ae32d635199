"""The newest lines of one node, bounded in number and in bytes."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING

from launcher.logs.kept_lines import KeptLines

if TYPE_CHECKING:
    from launcher.status import LogLine

MAX_LINES = 5000
MAX_BYTES = 4 << 20
LINE_COST = 300
"""Bytes that a line takes in addition to its text, if it is not compressed: the object and its
numbers."""


class LogRing:
    """Lines in the order of their `seq`, which counts from 1 without a gap."""

    def __init__(self, max_lines: int = MAX_LINES, max_bytes: int = MAX_BYTES) -> None:
        """`max_bytes` limits, approximately, the memory that the lines take."""
        self._lines = KeptLines()
        self._max_lines = max_lines
        self._max_bytes = max_bytes
        self._bytes = 0
        self.last_seq = 0

    def __len__(self) -> int:
        return len(self._lines)

    def append(self, line: LogLine) -> None:
        """Add the next line; the oldest ones are dropped when there is no room."""
        self._lines.append(line)
        self.last_seq = line.seq
        self._bytes += len(line.text) + LINE_COST
        while len(self._lines) > self._max_lines or self._bytes > self._max_bytes:
            lines, characters = self._lines.drop_oldest()
            self._bytes -= characters + lines * LINE_COST

    def newest(self, limit: int) -> list[LogLine]:
        """Return at most `limit` lines, oldest first."""
        lines = list(islice(reversed(self._lines), max(limit, 0)))
        lines.reverse()
        return lines

    def after(self, seq: int, limit: int, max_chars: int) -> list[LogLine]:
        """Return the newest lines that came after `seq`, bounded in number and length."""
        lines: list[LogLine] = []
        chars = 0
        for line in islice(reversed(self._lines), min(limit, self.last_seq - seq)):
            chars += len(line.text)
            if lines and chars > max_chars:
                break
            lines.append(line)
        lines.reverse()
        return lines
