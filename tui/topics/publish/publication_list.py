"""What Deck publishes periodically, with the number of messages sent."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.cells import cell_len

from text.i18n import _, decimal, localized
from text.plain import plain
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from graph.data import Publication

MOST_LINES = 5


class PublicationList(Rows):
    """One row for each; Enter stops the chosen one. It is hidden while there is none."""

    DEFAULT_CSS = """
    PublicationList { display: none; border-top: solid $panel; }
    PublicationList.-some { display: block; }
    """

    def __init__(self) -> None:
        super().__init__()
        self._shown: tuple[Publication, ...] = ()

    def show_publications(self, publications: tuple[Publication, ...]) -> None:
        self._shown = publications
        columns = (
            Column(_("Publishing")),
            Column(_("Hz"), 7, right=True),
            Column(_("Sent"), max(8, cell_len(_("Sent"))), right=True),
            Column(_("Subscribers"), 11, right=True),
        )
        self.show(columns, [_row(one) for one in publications])
        self.set_class(bool(publications), "-some")
        # The header and the line above it are in addition to the rows.
        self.styles.height = min(MOST_LINES, len(publications)) + 2

    @property
    def chosen_number(self) -> int | None:
        return int(self.chosen) if self._shown and self.chosen else None


def _row(one: Publication) -> Row:
    if one.error:
        words = Cell(f"✗ {plain(one.topic, 100)}: {plain(localized(one.error), 200)}", "bad")
        return Row(str(one.number), (words,))
    heard = Cell(str(one.subscribers), "" if one.subscribers else "warn")
    cells = (Cell(plain(one.topic, 200)), Cell(decimal(f"{one.hz:g}")), Cell(str(one.sent)), heard)
    return Row(str(one.number), cells)
