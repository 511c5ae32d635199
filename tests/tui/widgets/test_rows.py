"""A list of rows: whole texts beside a scroll bar, and the chosen row never out of sight."""

from __future__ import annotations

from textual.app import App, ComposeResult

from tui.widgets.rows import Cell, Column, Row, Rows


class ListApp(App[None]):
    """A bare app with nothing but a list of twelve rows."""

    def compose(self) -> ComposeResult:
        """The list."""
        yield Rows()

    @property
    def rows(self) -> Rows:
        """The list."""
        return self.query_one(Rows)

    def fill(self) -> None:
        """Twelve rows whose last text ends at the right edge."""
        columns = Column("name"), Column("memory", 6, right=True)
        self.rows.show(columns, [Row(f"n{n}", (Cell(f"n{n}"), Cell("19 MB"))) for n in range(12)])

    def lines(self) -> list[str]:
        """What can be seen of it."""
        width = self.rows.scrollable_size.width
        shown = range(self.rows.size.height)
        return [self.rows.render_line(y).crop(0, width).text.rstrip() for y in shown]


async def test_the_chosen_row_stays_in_sight_when_the_terminal_shrinks() -> None:
    app = ListApp()
    async with app.run_test(size=(30, 20)) as pilot:
        app.fill()
        app.rows.choose("n9")
        await pilot.resize_terminal(30, 6)
        await pilot.pause()
        assert any("▶ n9" in line for line in app.lines())
