"""The names of one kind; a chosen name that has left the graph stays until another is chosen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import _
from text.plain import plain
from tui.graph.places import GraphKind
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tui.graph.index import GraphEntry

LONGEST = 300


class GraphList(Rows):
    """Shows names; one that does not fit loses its beginning."""

    def __init__(self) -> None:
        super().__init__(header=False)
        self._named: tuple[tuple[str, bool], ...] = ()
        """Name, and whether it still exists."""
        self._kind = GraphKind.NODE

    @property
    def chosen_name(self) -> str:
        """The chosen one."""
        return self.chosen.partition("|")[2]

    def show_entries(
        self, kind: GraphKind, shown: Sequence[GraphEntry], chosen: str, words: str
    ) -> None:
        """Show these entries; `chosen` was chosen last, and `words` are the filter."""
        names = [(entry.name, True) for entry in shown]
        if chosen and not words and chosen not in {entry.name for entry in shown}:
            # A type does not disappear when nobody uses it.
            names.append((chosen, kind is GraphKind.TYPE))
        self._kind, self._named = kind, tuple(names)
        self._lay()
        if chosen:
            self.choose(f"{kind.value}|{chosen}")

    def on_resize(self) -> None:
        """Shorten the names for the new width."""
        self._lay()

    def _lay(self) -> None:
        rows = [self._row(self._kind, name, there=there) for name, there in self._named]
        self.show([Column("")], rows)

    def _row(self, kind: GraphKind, name: str, *, there: bool) -> Row:
        room = max(4, self.size.width - 4) if self.size.width else LONGEST
        words = plain(name, LONGEST)
        if not there:
            gone = _("gone")
            words = f"✗ {words} ({gone})"
        cell = Cell(ended(words, room), "" if there else "dim")
        return Row(f"{kind.value}|{name}", (cell,))


def ended(words: str, room: int) -> str:
    """Return the words, without their middle if they do not fit: both ends are informative."""
    if len(words) <= room:
        return words
    tail = (room - 1) * 2 // 3
    return words[: room - 1 - tail] + "…" + (words[-tail:] if tail else "")
