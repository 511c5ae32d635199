"""Rows with links: Enter on one goes to the place that it names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.plain import plain
from tui.graph.places import GraphKind, GraphPlace
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

LONGEST = 300
"""Characters of a name that are considered."""
ROOM_FOR_NAMES = 0.55


class GraphLinks(Rows):
    """Names, each with a remark beside it."""

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(header=False, id=id, classes="graph-links")
        self._shown: tuple[Row, ...] = ()

    def show_links(self, rows: Sequence[Row]) -> None:
        """Show these rows; names get the room that they need, up to a little over half."""
        self._shown = tuple(rows)
        self._lay()

    def on_resize(self) -> None:
        """Divide the width among the columns again."""
        self._lay()

    def _lay(self) -> None:
        width = self.size.width
        if width:
            names = [len(row.cells[0].text) for row in self._shown if len(row.cells) > 1]
            most = max(4, int(width * ROOM_FOR_NAMES))
            self.show([Column("", min(most, max(names, default=0)) or most), Column("")], self._shown)


def heading(words: str) -> Row:
    """Return a row that is only a heading."""
    return Row("", (Cell(words, "dim"),))


def link(place: GraphPlace, section: str, told: str = "", meaning: str = "dim") -> Row:
    """Return a row that links to a place, with a remark."""
    cells = (Cell(plain(place.name, LONGEST)), Cell(plain(told, LONGEST), meaning))
    return Row(place.key(section), cells if told else cells[:1])


def node_links(names: Iterable[str], section: str, told: str = "") -> list[Row]:
    """Return rows that link to these nodes."""
    return [link(GraphPlace(GraphKind.NODE, name), section, told) for name in names]


def short(name: str) -> str:
    """Return a name without the slash of the root namespace."""
    return plain(name.removeprefix("/"), LONGEST)
