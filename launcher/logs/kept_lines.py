"""Many lines in little memory: all but the newest are kept compressed."""

from __future__ import annotations

import json
import zlib
from collections import deque
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from launcher.status import LogLine, pack_line, unpack_line
from text.nested import read_json

if TYPE_CHECKING:
    from collections.abc import Iterator

    from launcher.status import LogLine

BLOCK_LINES = 250
"""Compressed together: one line alone has little that repeats."""
FASTEST = 1
"""The level of compression: logs become a sixth even so."""


class _Block(NamedTuple):
    lines: int
    characters: int
    packed: bytes


class KeptLines:
    """Lines in order of arrival; the oldest can be dropped."""

    def __init__(self) -> None:
        self._blocks: deque[_Block] = deque()
        self._newest: deque[LogLine] = deque()
        self._count = 0

    def __len__(self) -> int:
        return self._count

    def __reversed__(self) -> Iterator[LogLine]:
        older = (reversed(_unpacked(block)) for block in reversed(self._blocks))
        return chain(reversed(self._newest), chain.from_iterable(older))

    def append(self, line: LogLine) -> None:
        self._newest.append(line)
        self._count += 1
        if len(self._newest) >= 2 * BLOCK_LINES:
            self._blocks.append(_packed([self._newest.popleft() for _ in range(BLOCK_LINES)]))

    def drop_oldest(self) -> tuple[int, int]:
        """Drop the oldest line, or block of lines; return how many, and their characters."""
        if self._blocks:
            block = self._blocks.popleft()
            dropped = block.lines, block.characters
        else:
            dropped = 1, len(self._newest.popleft().text)
        self._count -= dropped[0]
        return dropped


def _packed(lines: list[LogLine]) -> _Block:
    rows = json.dumps([pack_line(line) for line in lines])
    characters = sum(len(line.text) for line in lines)
    return _Block(len(lines), characters, zlib.compress(rows.encode(), FASTEST))


def _unpacked(block: _Block) -> list[LogLine]:
    return [unpack_line(row) for row in read_json(zlib.decompress(block.packed))]
