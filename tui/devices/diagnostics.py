"""What everybody says on /diagnostics: a tree with the worst on top, and all about one status."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.containers import Horizontal, Vertical

from graph.diagnostics import StatusLevel, tree
from text.i18n import _, language
from text.plain import plain
from tui import clock
from tui.devices.drivers import STATES
from tui.widgets.name_head import NameHead
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.diagnostics import DiagnosticsBook, StatusRecord, TreeRow

MOST_NAME = 24


def level_cell(level: StatusLevel) -> Cell:
    """Return sign and word of a level."""
    words, meaning = STATES[level]
    return Cell(_(words), meaning)


def _tree_row(row: TreeRow) -> Row:
    """A name, indented, with the sign of the worst below it."""
    sign, meaning = level_cell(row.level)
    said = "" if row.record is None or row.level is StatusLevel.OK else f"  {row.record.status.message}"
    return Row(row.key, (Cell(f"{'  ' * row.depth}{sign[0]} {plain(row.label)}{said}", meaning),))


def _fact_rows(record: StatusRecord) -> list[Row]:
    """The values of a status, and when its level has changed."""
    rows = [Row("", (Cell(_("History"), "dim"),))]
    for number, change in reversed(list(enumerate(record.history))):
        level, meaning = level_cell(change.level)
        words = f"{clock.time_of_day(change.at_s)}  {level}  {plain(change.message)}"
        rows.append(Row(f"change {number}", (Cell(words, meaning),)))
    values = record.status.values
    if values:
        rows.append(Row("", (Cell(_("Values"), "dim"),)))
    return rows + [
        Row(f"value {key}", (Cell(plain(key), "dim"), Cell(plain(value)))) for key, value in values.items()
    ]


class DiagnosticsView(Horizontal):
    """The tree at the left, the chosen status at the right."""

    DEFAULT_CSS = """
    DiagnosticsView {
        height: 1fr; display: none;
        #tree { width: 40%; }
        #status { width: 1fr; height: 1fr; border-left: solid $panel; }
    }
    """

    def __init__(self, book: DiagnosticsBook) -> None:
        """Show what is in this book whenever `redraw` is called."""
        super().__init__()
        self._book = book
        self._rows: tuple[TreeRow, ...] = ()
        self._drawn = (-1, "")
        """Revision of the book, and language."""

    def compose(self) -> ComposeResult:
        yield Rows(header=False, id="tree")
        with Vertical(id="status"):
            yield NameHead()
            yield Rows(header=False, id="facts")

    @property
    def names(self) -> Rows:
        return self.query_one("#tree", Rows)

    @property
    def facts(self) -> Rows:
        """The values of the chosen status, and when its level has changed."""
        return self.query_one("#facts", Rows)

    def redraw(self) -> None:
        wanted = (self._book.revision, language())
        if wanted != self._drawn:
            self._drawn = wanted
            self._rows = tree(self._book.records)
            self.names.show([Column("")], [_tree_row(row) for row in self._rows])
            self.show_chosen()

    def show_chosen(self) -> None:
        """Show the status at the cursor, or how many there are below it."""
        row = next((one for one in self._rows if one.key == self.names.chosen), None)
        if row is None:
            return
        head, rows, width = self.query_one(NameHead), [], 0
        state = level_cell(row.level).text
        if row.record is None:
            below = sum(one.record is not None and one.path[: len(row.path)] == row.path for one in self._rows)
            head.show(" / ".join(row.path), f"{state} · " + _("reports: {n}").format(n=below))
        else:
            status = row.record.status
            own = level_cell(row.record.level).text
            head.show(status.name, f"{own} · {status.message}", status.hardware)
            rows = _fact_rows(row.record)
            width = min(MOST_NAME, max(map(len, status.values), default=0)) or MOST_NAME
        self.facts.show([Column("", width), Column("")] if width else [Column("")], rows)


def worst_of(book: DiagnosticsBook) -> str:
    """Return `bad` or `warn` for the colour of the tab; empty if all is well or stale."""
    worst = min((record.level.rank for record in book.records), default=StatusLevel.OK.rank)
    return {StatusLevel.ERROR.rank: "bad", StatusLevel.WARN.rank: "warn"}.get(worst, "")
