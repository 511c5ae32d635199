"""Texts over a picture: none over another, and each where it was in the picture before."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

NEAR = (0, 1, -1, 2, -2)
"""By how many rows a text may be away from its place."""
MARGIN = 3
"""Free columns about a place to which a text returns: with fewer it would soon have to go again."""


class WrittenSign(NamedTuple):
    """A text with its row and first column."""

    row: int
    column: int
    text: str
    paint: int


class SignRows:
    """The texts of one picture; what is written first keeps its place."""

    def __init__(self, rows: int, before: Mapping[str, int | None]) -> None:
        """`before` is what `moved` was in the picture before."""
        self.written: list[WrittenSign] = []
        self.moved: dict[str, int | None] = {}
        """By how many rows each name is away from its place; None for one that is left out."""
        self._rows = rows
        self._taken: dict[int, list[tuple[int, int]]] = defaultdict(list)
        """Row to the columns from and to which it has texts."""
        self._before = before

    def write(self, row: int, column: int, text: str, paint: int, name: str) -> None:
        """Write a text, in a row close by if its own is taken, or leave it out.

        `name` is by what it is known in the next picture; with none it is not remembered.
        """
        for away in self._choices(name):
            wants_room = self._returns(name, away)
            if self._is_free(row + away, column, len(text), MARGIN if wants_room else 0):
                self.written.append(WrittenSign(row + away, column, text, paint))
                self._taken[row + away].append((column, column + len(text)))
                self._note(name, away)
                return
        self._note(name, None)

    def _choices(self, name: str) -> tuple[int, ...]:
        before = self._before.get(name)
        return NEAR if not before else (0, before, *(away for away in NEAR[1:] if away != before))

    def _returns(self, name: str, away: int) -> bool:
        """Whether it was elsewhere, or left out, in the picture before."""
        if name not in self._before:
            return False
        before = self._before[name]
        return before is None or (away == 0 and before != 0)

    def _note(self, name: str, away: int | None) -> None:
        if name:
            self.moved[name] = away

    def _is_free(self, row: int, column: int, length: int, margin: int) -> bool:
        begin, end = column - margin, column + length + 1 + margin
        return 0 <= row < self._rows and all(
            end <= other_begin or begin > other_end for other_begin, other_end in self._taken[row]
        )
