"""A list of rows: whole texts beside a scroll bar, and the chosen row never out of sight."""

from __future__ import annotations

import pytest
from rich.color import Color
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


async def test_the_last_column_is_whole_beside_the_scroll_bar() -> None:
    app = ListApp()
    async with app.run_test(size=(30, 6)) as pilot:
        app.fill()
        await pilot.pause()
        assert app.rows.show_vertical_scrollbar
        assert app.lines()[1].endswith("19 MB")


async def test_the_chosen_row_stays_in_sight_when_the_terminal_shrinks() -> None:
    app = ListApp()
    async with app.run_test(size=(30, 20)) as pilot:
        app.fill()
        app.rows.choose("n9")
        await pilot.resize_terminal(30, 6)
        await pilot.pause()
        assert any("▶ n9" in line for line in app.lines())


async def test_a_row_that_is_chosen_as_soon_as_the_rows_come_is_in_sight() -> None:
    app = ListApp()
    async with app.run_test(size=(30, 6)) as pilot:
        app.fill()
        app.rows.choose("n9")
        await pilot.pause()
        assert any("▶ n9" in line for line in app.lines())


def green(ink: Color | None) -> int:
    """How much green is in a colour of RGB."""
    assert ink is not None
    assert ink.triplet is not None
    return ink.triplet.green


async def test_what_is_dim_is_between_text_and_background_in_every_theme() -> None:
    app = ListApp()
    async with app.run_test(size=(30, 20)) as pilot:
        for theme in ("textual-dark", "textual-light"):
            app.theme = theme
            app.rows.show((Column("pid"),), [Row("a", (Cell("7"),)), Row("b", (Cell("8", "dim"),))])
            await pilot.pause()
            (dim,) = [part for part in app.rows.render_line(2) if part.text.startswith("8")]
            text, ground = app.rows.rich_style.color, app.rows.rich_style.bgcolor
            assert dim.style is not None
            greys = [green(ink) for ink in (ground, dim.style.color, text)]
            assert sorted(greys) in (greys, greys[::-1])
            assert len(set(greys)) == 3, theme


async def test_the_cursor_is_softer_while_the_list_has_no_focus() -> None:
    app = ListApp()
    async with app.run_test(size=(30, 20)) as pilot:
        app.fill()
        looks = []
        for focused in (app.rows, None):
            app.screen.set_focus(focused)
            await pilot.pause()
            style = next(iter(app.rows.render_line(1))).style
            assert style is not None
            looks.append(style.bgcolor)
        assert looks[0] != looks[1]


async def test_a_new_size_that_nobody_tells_of_is_used(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Rows, "on_resize", lambda _rows: None)
    app = ListApp()
    async with app.run_test(size=(30, 20)) as pilot:
        app.fill()
        await pilot.pause()
        await pilot.resize_terminal(60, 20)
        await pilot.pause()
        shown = app.screen._compositor.render_strips()[1].text
        assert shown.rstrip().endswith("19 MB")
        assert len(shown.rstrip()) == 60
