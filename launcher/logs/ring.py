"""The newest lines of one node, bounded in number and in bytes; all but the newest are compressed."""

from __future__ import annotations

import json
import zlib
from collections import deque
from collections.abc import Iterator
from itertools import chain, islice
from typing import NamedTuple

from launcher.status import LogLine
from text.nested import read_json

BLOCK_LINES = 250
"""Compressed together: one line alone has little that repeats."""
FASTEST = 1
"""The level of compression: logs become a sixth even so."""


class _Block(NamedTuple):
    lines: int
    characters: int
    packed: bytes


MAX_LINES = 5000
MAX_BYTES = 4 << 20
LINE_COST = 300
"""Bytes that a line takes in addition to its text, if it is not compressed: the object and its
numbers."""


class LogRing:
    """Lines in the order of their `seq`, which counts from 1 without a gap."""

    def __init__(self, max_lines: int = MAX_LINES, max_bytes: int = MAX_BYTES) -> None:
        """`max_bytes` limits, approximately, the memory that the lines take."""
        self._blocks: deque[_Block] = deque()
        self._newest: deque[LogLine] = deque()
        self._max_lines, self._max_bytes = max_lines, max_bytes
        self._count = self._bytes = 0
        self.last_seq = 0

    def __len__(self) -> int:
        return self._count

    def __reversed__(self) -> Iterator[LogLine]:
        older = (reversed(_unpacked(block)) for block in reversed(self._blocks))
        return chain(reversed(self._newest), chain.from_iterable(older))

    def append(self, line: LogLine) -> None:
        """Add the next line; the oldest ones are dropped when there is no room."""
        self._newest.append(line)
        self.last_seq = line.seq
        self._count += 1
        self._bytes += len(line.text) + LINE_COST
        if len(self._newest) >= 2 * BLOCK_LINES:
            self._blocks.append(_packed([self._newest.popleft() for _ in range(BLOCK_LINES)]))
        while self._count > self._max_lines or self._bytes > self._max_bytes:
            self._drop_oldest()

    def _drop_oldest(self) -> None:
        """Drop the oldest line, or block of lines."""
        if self._blocks:
            lines, characters, _packed = self._blocks.popleft()
        else:
            lines, characters = 1, len(self._newest.popleft().text)
        self._count -= lines
        self._bytes -= characters + lines * LINE_COST

    def newest(self, limit: int) -> list[LogLine]:
        """Return at most `limit` lines, oldest first."""
        lines = list(islice(reversed(self), max(limit, 0)))
        lines.reverse()
        return lines

    def after(self, seq: int, limit: int, max_chars: int) -> list[LogLine]:
        """Return the newest lines that came after `seq`, bounded in number and length."""
        lines: list[LogLine] = []
        chars = 0
        for line in islice(reversed(self), min(limit, self.last_seq - seq)):
            chars += len(line.text)
            if lines and chars > max_chars:
                break
            lines.append(line)
        lines.reverse()
        return lines


def _packed(lines: list[LogLine]) -> _Block:
    rows = json.dumps([line.packed() for line in lines])
    characters = sum(len(line.text) for line in lines)
    return _Block(len(lines), characters, zlib.compress(rows.encode(), FASTEST))


def _unpacked(block: _Block) -> list[LogLine]:
    return [LogLine.unpacked(row) for row in read_json(zlib.decompress(block.packed))]
