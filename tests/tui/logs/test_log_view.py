"""The log view under hands: following, pausing, choosing, searching, copying."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import pytest
from rich.cells import cell_len

from launcher.status import Severity
from tests.tui.logs.bare_log import HOSTILE, LogApp, line, lines, rows, shown, texts
from tests.waiting import until
from tui.log_view.bar import LogBar
from tui.log_view.filter import LogFilter
from tui.log_view.view import LogView

if TYPE_CHECKING:
    pass


async def test_the_newest_line_stays_in_sight() -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        view = await shown(pilot, lines(1, 100))
        assert texts(view)[-1] == "line 100"
        await shown(pilot, lines(101, 5))
        assert texts(view)[-1] == "line 105"
        assert view.following


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


async def test_a_name_of_a_node_that_its_column_cuts_is_told_whole_of_the_line_pointed_at() -> None:
    long = "left_arm.electronic_differential_of_the_rear"
    async with LogApp().run_test(size=(80, 12)) as pilot:
        view = await shown(pilot, [line(1), line(2, node=long)])
        bar = pilot.app.query_one(LogBar)
        assert long not in "\n".join(rows(view)) + bar.words
        await pilot.press("up")
        assert long in bar.render().plain
        await pilot.press("up")
        assert "sonar_front" not in bar.words
        await pilot.press("down", "end")
        assert long not in bar.words


async def test_scrolling_back_down_to_the_end_follows_again() -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        view = await shown(pilot, lines(1, 100))
        await pilot.press("pageup")
        assert not view.following
        await pilot.press("pagedown")
        assert view.following


async def test_the_wheel_pauses_too() -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        view = await shown(pilot, lines(1, 100))
        view._on_mouse_scroll_up(_wheel(view))
        await pilot.pause()
        assert not view.following


def _wheel(view: LogView):  # type: ignore[no-untyped-def]  # noqa: ANN202
    from textual.events import MouseScrollUp

    return MouseScrollUp(view, 1, 1, 0, -1, 0, False, False, False, 1, 1)


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


async def test_without_a_line_it_says_so() -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        assert "no lines yet" in rows(await shown(pilot, []))[0]


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


async def test_next_and_previous_walk_over_the_found_lines() -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        view = await shown(pilot, lines(1, 100))
        view.log_filter = LogFilter(search="9")
        numbers = []
        for step in (-1, -1, 1, 1, 1):
            assert view.find(step)
            numbers.append(view.choice.found_number)
        assert numbers == [19, 18, 19, 1, 2]
        assert not view.following
        view.log_filter = LogFilter(search="nowhere")
        assert not view.find(1)


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


async def test_text_can_be_selected_with_the_mouse_across_folded_lines() -> None:
    async with LogApp().run_test(size=(50, 12)) as pilot:
        long = "a line that is folded on this narrow screen, twice over"
        view = await shown(pilot, [line(1, "first"), line(2, long), line(3, "third")])
        lead = len(view.row_text(view.index.shown[0])) - len("first")
        await pilot.mouse_down(LogView, offset=(lead, 0))
        await pilot.hover(LogView, offset=(lead + 5, 4))
        await pilot.mouse_up(LogView, offset=(lead + 5, 4))
        selected = pilot.app.screen.get_selected_text()
        assert selected is not None
        first, second, third = selected.splitlines()
        assert (first, second[lead:]) == ("first", long)
        assert third.endswith("third"[:5])
        assert not view.following


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


async def test_hostile_text_is_harmless() -> None:
    async with LogApp().run_test(size=(60, 20)) as pilot:
        view = await shown(pilot, [line(seq, text or " ") for seq, text in enumerate(HOSTILE, 1)])
        for fold in (True, False):
            view.set_fold(fold)
            await pilot.press("home")
            for _page in range(4):
                for y in range(view.size.height):
                    strip = view.render_line(y)
                    strip.text.encode("utf-8")
                    assert cell_len(strip.text) == strip.cell_length
                    assert strip.text.isprintable() or "\u200d" in strip.text
                await pilot.press("pagedown", "right")
        view.log_filter = LogFilter(search="[red]")
        assert len(view.index.found) == 1
        assert "markup[/red]" in view.shown_lines()[1]


@pytest.mark.parametrize("size", [(1, 1), (5, 3), (20, 2), (300, 100)])
async def test_it_fits_any_terminal(size: tuple[int, int]) -> None:
    async with LogApp().run_test(size=size) as pilot:
        view = await shown(pilot, [line(seq, text) for seq, text in enumerate(HOSTILE, 1)])
        await pilot.press("up", "up", "shift+up", "home", "end")
        await pilot.resize_terminal(80, 24)
        await pilot.pause()
        assert any("markup" in row for row in (view.row_text(e) for e in view.index.shown))


async def test_resizing_keeps_the_line_that_was_at_the_top() -> None:
    async with LogApp().run_test(size=(60, 12)) as pilot:
        words = " ".join(["word"] * 20)
        view = await shown(pilot, [line(seq, f"{seq}: {words}") for seq in range(1, 60)])
        await pilot.press("pageup", "pageup")
        top = view.top_id
        await pilot.resize_terminal(100, 14)
        await pilot.pause()
        assert view.top_id == top


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


async def test_batches_that_come_close_together_are_drawn_once() -> None:
    async with LogApp(period_s=0.05).run_test(size=(80, 24)) as pilot:
        view = await shown(pilot, lines(1, 10))
        drawn = []
        redraw = view._tail.redraw

        def note(**how: Any) -> None:
            drawn.append(1)
            redraw(**how)

        view._tail.redraw = note  # type: ignore[method-assign]
        for batch in range(20):
            view.append(lines(11 + batch * 10, 10))
        await until(lambda: drawn, "the first drawing")
        assert len(drawn) == 1
        assert texts(view)[-1] == "line 210"
