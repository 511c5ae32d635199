"""The parts that a log view asks, each by itself: what is chosen, the tail, the drawn rows."""

from __future__ import annotations

import pytest
from textual.app import App, ComposeResult
from textual.scroll_view import ScrollView
from textual.widget import Widget

from launcher.status import LogLine, Severity
from tui.log_view.choice import LineChoice, exported
from tui.log_view.drawing import DrawnRows
from tui.log_view.filter import LogFilter
from tui.log_view.index import LogIndex
from tui.log_view.palette import PALETTE_CLASSES
from tui.log_view.ring import LineRing
from tui.log_view.rows import LogColumns, text_of
from tui.log_view.tail import Tail


def index_of(count: int) -> LogIndex:
    """So many lines of three nodes in turn."""
    index = LogIndex(text_of)
    lines = [
        LogLine(f"node{n % 3}", 1 + n // 3, 0.0, Severity.INFO, f"line {n}") for n in range(count)
    ]
    index.extend(LineRing().append(lines, {}))
    return index


def test_a_choice_reaches_from_where_it_began_to_the_cursor() -> None:
    choice = LineChoice(index_of(10))
    choice.move(4, extend=False)
    choice.move(6, extend=True)
    choice.move(2, extend=True)
    assert [entry.id for entry in choice.entries] == [2, 3, 4]
    assert choice.node == "node2"
    assert 3 in choice
    assert 5 not in choice
    choice.move(5, extend=False)
    assert [entry.id for entry in choice.entries] == [5]
    choice.clear()
    assert not choice.entries
    assert choice.node is None


def test_of_a_choice_only_the_lines_that_are_shown_count() -> None:
    index = index_of(10)
    choice = LineChoice(index)
    choice.move(0, extend=False)
    choice.move(9, extend=True)
    shown = list(index.shown)
    index.filter = LogFilter(only="node1")
    index.rebuild(shown)
    assert {entry.node for entry in choice.entries} == {"node1"}
    assert choice.node is None
    assert exported(choice.entries, index)[0].endswith("INFO  node1: line 1")


class Rows(ScrollView):
    """A view of as many rows as it is told."""

    def __init__(self) -> None:
        super().__init__()
        self.rows = 0
        self.drawn = 0
        self.tail = Tail(self, lambda: self.rows, self.count, 0.0)

    def count(self) -> None:
        """Count the drawings."""
        self.drawn += 1

    def grow(self, rows: int) -> None:
        """Have more rows."""
        self.rows += rows
        self.tail.rows_came()


class RowsApp(App[None]):
    """Nothing but the rows."""

    CSS = "Rows { height: 10; overflow-y: scroll; }"

    def compose(self) -> ComposeResult:
        """The rows."""
        yield Rows()


async def test_a_tail_keeps_the_newest_row_in_sight_until_it_stands_still() -> None:
    async with RowsApp().run_test() as pilot:
        view = pilot.app.query_one(Rows)
        view.grow(100)
        assert (view.scroll_y, view.drawn) == (90, 1)
        view.tail.following = False
        view.grow(50)
        assert (view.scroll_y, view.virtual_size.height) == (90, 150)
        view.tail.following = True
        view.tail.redraw()
        assert view.scroll_y == 140


@pytest.mark.parametrize(
    ("first", "end", "top"), [(3, 4, 3), (55, 56, 50), (70, 71, 61), (20, 90, 20)]
)
async def test_a_tail_scrolls_as_little_as_it_can(first: int, end: int, top: int) -> None:
    async with RowsApp().run_test() as pilot:
        view = pilot.app.query_one(Rows)
        view.tail.following = False
        view.grow(100)
        view.tail.steer(50)
        view.tail.show(first, end)
        assert view.scroll_y == top
        assert not view.tail.steering


class Page(Widget):
    """A widget in whose colours rows are drawn."""

    COMPONENT_CLASSES = PALETTE_CLASSES


class PageApp(App[None]):
    """Nothing but the page."""

    def compose(self) -> ComposeResult:
        """The page."""
        yield Page()


async def test_a_row_is_drawn_once_until_it_looks_different() -> None:
    async with PageApp().run_test(size=(30, 5)) as pilot:
        index = index_of(4)
        rows = DrawnRows(
            pilot.app.query_one(Page), index, lambda _width, _node: LogColumns(0, 0, 5), fold=False
        )
        assert rows.know_nodes(["node0", "node1", "node2"])
        assert not rows.know_nodes(["node1"])
        rows.lay_out(30, 2)
        entry = index.shown[1]
        strip = rows.strip(entry, 0, None, chosen=False)
        assert strip.text.rstrip() == " node1 line 1"
        assert rows.strip(entry, 0, None, chosen=False) is strip
        for other in (0, 2, 3, 0):
            rows.strip(index.shown[other], 0, None, chosen=False)
        assert rows.strip(entry, 0, None, chosen=False) is strip, "two pages are kept"
        for other in range(4):
            rows.strip(index.shown[other], 1, None, chosen=False)
        assert rows.strip(entry, 0, None, chosen=False) is not strip, "and no more"
        strip = rows.strip(entry, 0, None, chosen=False)
        rows.forget()
        assert rows.strip(entry, 0, None, chosen=False) is not strip
        assert not rows.cuts("node1")
        assert rows.cuts("a_long_name")


async def test_only_lines_that_are_not_folded_can_be_shifted_and_no_further_than_they_reach() -> (
    None
):
    async with PageApp().run_test(size=(20, 5)) as pilot:
        index = LogIndex(text_of)
        line = LogLine("a", 1, 0.0, Severity.INFO, "0123456789" * 3)
        index.extend(LineRing().append([line], {}))
        rows = DrawnRows(
            pilot.app.query_one(Page), index, lambda _width, _node: LogColumns(0, 0, 0), fold=False
        )
        rows.know_nodes(["a"])
        rows.lay_out(20, 5)
        assert rows.shift(16)
        rows.forget()
        assert rows.strip(index.shown[0], 0, None, chosen=False).text.strip()[:3] == "123"
        assert not rows.shift(16)
        rows.set_fold(True)
        rows.lay_out(20, 5)
        assert not rows.shift(16)
