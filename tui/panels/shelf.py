"""The panels side by side and below each other; what does not fit is turned to, page by page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.containers import Container

from tui.i18n import _

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual.events import Resize

    from tui.panels.panel import Panel

BESIDE_FROM = 52
"""Cells from which on two panels stand side by side."""


class Shelf(Container):
    """Shows as many panels as have room, and says how many pages there are."""

    DEFAULT_CSS = """
    Shelf { layout: grid; grid-gutter: 0; width: 1fr; height: 1fr; overflow: hidden; }
    """

    def __init__(self, panels: Sequence[Panel], id: str | None = None) -> None:
        """Hold these panels, the first ones first."""
        super().__init__(*panels, id=id)
        self._panels = list(panels)
        self._page = 0
        self._pages: list[list[list[Panel]]] = []

    @property
    def pages(self) -> int:
        """How many pages there are."""
        return len(self._pages)

    @property
    def panels(self) -> Sequence[Panel]:
        """All panels, shown or not."""
        return self._panels

    def turn(self) -> None:
        """Show the next page."""
        if self._pages:
            self._page = (self._page + 1) % len(self._pages)
            self._lay_out()

    def on_resize(self, event: Resize) -> None:
        """Place the panels anew."""
        beside = event.size.width >= BESIDE_FROM
        self._pages = paged(in_rows(self._panels, beside=beside), event.size.height)
        self._page = min(self._page, max(0, len(self._pages) - 1))
        self._lay_out()

    def words_changed(self) -> None:
        """Say the page in another language."""
        self._lay_out()

    def _lay_out(self) -> None:
        rows = self._pages[self._page] if self._pages else []
        columns = max((len(row) for row in rows), default=1)
        self.styles.grid_size_columns = columns
        shares = [max(panel.weight for panel in row) for row in rows]
        self.styles.grid_rows = " ".join(f"{share}fr" for share in shares) or "1fr"
        shown = [panel for row in rows for panel in row]
        for panel in self._panels:
            panel.display = panel in shown
            panel.border_subtitle = ""
        for row in rows:
            row[-1].styles.column_span = columns - len(row) + 1
        if shown and len(self._pages) > 1:
            page = _("{page} of {pages} · v").format(page=self._page + 1, pages=len(self._pages))
            shown[-1].border_subtitle = page


def in_rows(panels: Sequence[Panel], *, beside: bool) -> list[list[Panel]]:
    """Put panels into rows of one, or of two but for those that go across."""
    rows: list[list[Panel]] = []
    open_row: list[Panel] | None = None
    for panel in panels:
        if panel.across or not beside:
            rows.append([panel])
        elif open_row is None:
            open_row = [panel]
            rows.append(open_row)
        else:
            open_row.append(panel)
            open_row = None
    return rows


def paged(rows: Sequence[list[Panel]], height: int) -> list[list[list[Panel]]]:
    """Put rows onto pages of so many lines, at least one row on each."""
    pages: list[list[list[Panel]]] = []
    room = 0
    for row in rows:
        needed = max(panel.least for panel in row)
        if not pages or needed > room:
            pages.append([])
            room = height
        pages[-1].append(row)
        room -= needed
    return pages
