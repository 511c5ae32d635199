"""What everybody says on /diagnostics: a tree with the worst on top, and all about one status."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.containers import Horizontal, Vertical

from graph.diagnostics import StatusLevel, tree
from text.i18n import _, language
from text.plain import plain
from tui import clock
from tui.devices.table import STATES
from tui.widgets.name_head import NameHead
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual.app import ComposeResult

    from graph.diagnostics import DiagnosticsBook, StatusRecord, TreeRow

TIME = 8
"""Cells of a time of day."""
STATE = 14
"""Cells of a level in words."""
MOST_NAME = 24


def level_cell(level: StatusLevel) -> Cell:
    """Return sign and word of a level."""
    words, meaning = STATES[level]
    return Cell(_(words), meaning)


class DiagnosticsTree(Rows):
    """Names, indented, each with the sign of the worst below it."""

    def __init__(self) -> None:
        super().__init__(header=False)

    def show_tree(self, rows: Sequence[TreeRow]) -> None:
        self.show([Column("")], [self._row(row) for row in rows])

    @staticmethod
    def _row(row: TreeRow) -> Row:
        words, meaning = STATES[row.level]
        sign = _(words)[0]
        said = "" if row.record is None or row.level is StatusLevel.OK else row.record.status.message
        name = f"{'  ' * row.depth}{sign} {plain(row.label)}"
        return Row(row.key, (Cell(f"{name}  {said}" if said else name, meaning),))


class StatusFacts(Rows):
    """The values of a status, and when its level has changed."""

    def __init__(self) -> None:
        super().__init__(header=False)

    def show_record(self, record: StatusRecord | None) -> None:
        """Show this status; None shows nothing."""
        if record is None:
            self.show([Column("")], [])
            return
        values = record.status.values
        width = min(MOST_NAME, max(map(len, values), default=0)) or MOST_NAME
        rows = [Row("", (Cell(_("History"), "dim"),))]
        for number, change in reversed(list(enumerate(record.history))):
            told = f"{clock.time_of_day(change.at_s)}  {level_cell(change.level).text}"
            words = f"{told}  {plain(change.message)}"
            rows.append(Row(f"change {number}", (Cell(words, level_cell(change.level).meaning),)))
        if values:
            rows.append(Row("", (Cell(_("Values"), "dim"),)))
        rows += [Row(f"value {key}", (Cell(plain(key), "dim"), Cell(plain(value)))) for key, value in values.items()]
        self.show([Column("", width), Column("")], rows)


class DiagnosticsView(Horizontal):
    """The tree at the left, the chosen status at the right."""

    DEFAULT_CSS = """
    DiagnosticsView {
        height: 1fr; display: none;
        DiagnosticsTree { width: 40%; }
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
        yield DiagnosticsTree()
        with Vertical(id="status"):
            yield NameHead()
            yield StatusFacts()

    @property
    def names(self) -> DiagnosticsTree:
        return self.query_one(DiagnosticsTree)

    def redraw(self) -> None:
        """Show the current state of the book."""
        wanted = (self._book.revision, language())
        if wanted != self._drawn:
            self._drawn = wanted
            self._rows = tree(self._book.records)
            self.names.show_tree(self._rows)
            self.show_chosen()

    def show_chosen(self) -> None:
        """Show the status at the cursor, or how many there are below it."""
        row = next((one for one in self._rows if one.key == self.names.chosen), None)
        if row is None:
            return
        head, facts = self.query_one(NameHead), self.query_one(StatusFacts)
        state = level_cell(row.level).text
        if row.record is None:
            below = sum(one.record is not None and one.path[: len(row.path)] == row.path for one in self._rows)
            head.show(" / ".join(row.path), f"{state} · " + _("reports: {n}").format(n=below))
        else:
            status = row.record.status
            own = level_cell(row.record.level).text
            head.show(status.name, f"{own} · {status.message}", status.hardware)
        facts.show_record(row.record)


def worst_of(book: DiagnosticsBook) -> str:
    """Return `bad` or `warn` for the colour of the tab; empty if all is well or stale."""
    worst = min((record.level.rank for record in book.records), default=StatusLevel.OK.rank)
    return {StatusLevel.ERROR.rank: "bad", StatusLevel.WARN.rank: "warn"}.get(worst, "")
