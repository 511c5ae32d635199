"""The names of one kind; a chosen name that has left the graph stays until another is chosen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _
from text.plain import plain
from tui.graph.index import GraphEntry
from tui.graph.places import GraphKind
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from collections.abc import Sequence

LONGEST = 300


class GraphList(Rows):
    """Shows names; one that does not fit loses its beginning."""

    def __init__(self) -> None:
        super().__init__(header=False)
        self._listed: tuple[tuple[GraphEntry, bool], ...] = ()
        """Each entry, and whether it still exists."""
        self._kind = GraphKind.NODE

    @property
    def chosen_name(self) -> str:
        return self.chosen.partition("|")[2]

    def show_entries(self, kind: GraphKind, shown: Sequence[GraphEntry], chosen: str, words: str) -> None:
        """Show these entries; `chosen` was chosen last, and `words` are the filter."""
        listed = [(entry, True) for entry in shown]
        missing = chosen and not words and chosen not in {entry.name for entry in shown}
        # A finding that has gone was fixed.
        if missing and kind is not GraphKind.FINDING:
            # A type does not disappear when nobody uses it.
            listed.append((GraphEntry(chosen), kind is GraphKind.TYPE))
        self._kind, self._listed = kind, tuple(listed)
        self.on_resize()
        if chosen:
            self.choose(f"{kind.value}|{chosen}")

    def on_resize(self) -> None:
        """Shorten the names for the new width."""
        self.show([Column("")], [self._row(entry, there=there) for entry, there in self._listed])

    def _row(self, entry: GraphEntry, *, there: bool) -> Row:
        room = max(4, self.size.width - 4) if self.size.width else LONGEST
        words = plain(entry.label or entry.name, LONGEST)
        if not there:
            words = f"✗ {words} (" + _("gone") + ")"
        if entry.remark and len(words) + len(entry.remark) + 2 <= room:
            words = f"{words}  {entry.remark}"
        cell = Cell(ended(words, room), entry.meaning if there else "dim")
        return Row(f"{self._kind.value}|{entry.name}", (cell,))


def ended(words: str, room: int) -> str:
    """Return the words, without their middle if they do not fit: both ends are informative."""
    if len(words) <= room:
        return words
    tail = (room - 1) * 2 // 3
    return words[: room - 1 - tail] + "…" + (words[-tail:] if tail else "")
