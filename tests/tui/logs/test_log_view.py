"""The log view under hands: following, pausing, choosing, searching, copying."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import pytest

from launcher.status import Severity
from tests.tui.logs.bare_log import HOSTILE, LogApp, line, lines, rows, shown, texts
from tui.log_view.bar import LogBar
from tui.log_view.filter import LogFilter
from tui.log_view.view import LogView

if TYPE_CHECKING:
    pass


async def test_scrolling_up_pauses_counts_what_is_new_and_end_follows() -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        view = await shown(pilot, lines(1, 100))
        await pilot.press("pageup")
        before = texts(view)
        await shown(pilot, lines(101, 500))
        assert texts(view) == before
        assert "paused, 500 new" in pilot.app.query_one(LogBar).words
        await pilot.press("end")
        assert view.following
        assert texts(view)[-1] == "line 600"
        assert "following" in pilot.app.query_one(LogBar).words


async def test_a_flood_does_not_move_what_somebody_reads() -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        view = await shown(pilot, lines(1, 100))
        view.ring.max_lines = 200
        await pilot.press("home")
        before = texts(view)
        for batch in range(20):
            await shown(pilot, lines(101 + batch * 100, 100))
        assert texts(view) == before
        assert len(view.ring.entries) <= 100 + 250 + 1
        await pilot.press("end")
        await shown(pilot, lines(2101, 1))
        assert texts(view)[-1] == "line 2101"
        assert len(view.ring.entries) <= 250


async def test_the_filter_works_by_node_severity_and_text() -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        view = await shown(
            pilot,
            [
                line(1, "one", "a"),
                line(1, "two", "b", Severity.WARN),
                line(2, "three", "a", Severity.ERROR),
            ],
        )
        view.log_filter = LogFilter(only="a")
        assert [entry.text for entry in view.index.shown] == ["one", "three"]
        view.log_filter = LogFilter(minimum=Severity.WARN)
        assert [entry.text for entry in view.index.shown] == ["two", "three"]
        view.log_filter = LogFilter(search="TWO", only_found=True)
        assert [entry.text for entry in view.index.shown] == ["two"]
        view.log_filter = LogFilter(search="four", only_found=True)
        await pilot.pause()
        assert "no line of 3 passes the filter" in rows(view)[0]


async def test_skipped_lines_are_told_with_the_file_that_has_them() -> None:
    async with LogApp().run_test(size=(100, 12)) as pilot:
        view = await shown(pilot, [line(1), line(1242)])
        assert (
            "1\u00a0240 lines skipped here; the file has them: /logs/sonar_front.log"
            in (rows(view)[1])
        )


async def test_search_finds_while_typing_marks_and_goes_round() -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        view = await shown(pilot, [*lines(1, 50), line(51, "Путь свободен"), *lines(52, 50)])
        app = pilot.app
        assert isinstance(app, LogApp)
        app.pane.search()
        await pilot.press(*"путь")
        assert len(view.index.found) == 1
        await pilot.press("enter")
        assert view.choice.found_number == 1
        assert any("Путь свободен" in row for row in rows(view))
        assert "“путь” 1/1" in app.query_one(LogBar).words
        app.pane.search()
        await pilot.pause()
        await pilot.press("escape")
        assert view.log_filter.search == ""
        assert view.has_focus


async def test_chosen_lines_are_copied_with_date_severity_and_node() -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        view = await shown(pilot, lines(1, 100))
        app = pilot.app
        assert isinstance(app, LogApp)
        await pilot.press("up", "up", "shift+up", "shift+up")
        assert len(view.choice.entries) == 3
        app.pane.copy()
        copied = app.clipboard.splitlines()
        assert [text.split(" ", 2)[2] for text in copied] == [
            f"INFO  sonar_front: line {seq}" for seq in (97, 98, 99)
        ]
        assert time.strptime(copied[0][:19], "%Y-%m-%d %H:%M:%S")
        app.pane.copy_all()
        assert len(app.clipboard.splitlines()) == 100


async def test_a_click_chooses_a_line_and_shift_click_all_up_to_it() -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        view = await shown(pilot, lines(1, 5))
        await pilot.click(LogView, offset=(5, 1))
        assert [entry.text for entry in view.choice.entries] == ["line 2"]
        assert not view.following
        await pilot.click(LogView, offset=(5, 3), shift=True)
        assert [entry.text for entry in view.choice.entries] == ["line 2", "line 3", "line 4"]
        assert rows(view)[1].startswith("▌")


async def test_long_lines_are_folded_or_shifted() -> None:
    async with LogApp().run_test(size=(60, 12)) as pilot:
        words = " ".join(f"word{number}" for number in range(30))
        view = await shown(pilot, [line(1, words)])
        assert view.index.rows > 3
        assert "word29" in rows(view)[view.index.rows - 1]
        view.set_fold(False)
        await pilot.pause()
        assert view.index.rows == 1
        assert rows(view)[0].endswith("›")
        await pilot.press(*["right"] * 30)
        assert rows(view)[0].endswith("word29")
        await pilot.press(*["left"] * 30)
        assert "word0 word1" in rows(view)[0]


@pytest.mark.parametrize("size", [(1, 1), (5, 3), (20, 2), (300, 100)])
async def test_it_fits_any_terminal(size: tuple[int, int]) -> None:
    async with LogApp().run_test(size=size) as pilot:
        view = await shown(pilot, [line(seq, text) for seq, text in enumerate(HOSTILE, 1)])
        await pilot.press("up", "up", "shift+up", "home", "end")
        await pilot.resize_terminal(80, 24)
        await pilot.pause()
        assert any("markup" in row for row in (view.row_text(e) for e in view.index.shown))


async def test_a_flood_measures_and_draws_next_to_nothing() -> None:
    """Ten thousand lines in twenty batches cost no layout and at most one drawing a batch."""
    async with LogApp().run_test(size=(80, 24)) as pilot:
        view = await shown(pilot, lines(1, 100))
        layouts = []
        app = pilot.app
        refresh_layout = app.screen._refresh_layout

        def note(*args: Any) -> None:
            layouts.append(1)
            refresh_layout(*args)

        app.screen._refresh_layout = note  # type: ignore[method-assign, assignment]
        for batch in range(20):
            await shown(pilot, lines(101 + batch * 500, 500))
        assert not layouts
        assert texts(view)[-1] == "line 10100"
