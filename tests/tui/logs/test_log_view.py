"""The log view under hands, its lines in a file, and what it keeps of a flood."""

from __future__ import annotations

import time
from collections import Counter
from pathlib import Path

from hypothesis import example, given
from hypothesis import strategies as st
from rich.cells import cell_len
from textual.app import App
from textual.pilot import Pilot

from launcher.status import LogLine, Severity
from tests.tui.logs.bare_log import LogApp, line, lines, rows, shown, texts
from tui.log_view.index import LineRing, LogFilter, folded, folded_rows
from tui.log_view.pane import LogBar, LogPrompt


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
            pilot, [line(1, "one", "a"), line(1, "two", "b", Severity.WARN), line(2, "three", "a", Severity.ERROR)]
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
        assert "1\u00a0240 lines skipped here; the file has them: /logs/sonar_front.log" in (rows(view)[1])


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


async def answer(pilot: Pilot[None], path: Path) -> None:
    app = pilot.app
    assert isinstance(app, LogApp)
    field = app.pane.prompt.query_one("Input")
    field.value = str(path)  # type: ignore[attr-defined]
    await pilot.press("enter")
    await app.workers.wait_for_complete()
    await pilot.pause()


def remark(app: App[None]) -> str:
    return str(app.query_one(LogPrompt).query_one("#remark").render())


async def test_lines_are_written_to_a_file_and_never_over_one_unasked(tmp_path: Path) -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        await shown(pilot, lines(1, 100))
        app = pilot.app
        assert isinstance(app, LogApp)
        app.pane.save_folder = str(tmp_path)
        app.pane.save()
        await pilot.pause()
        proposed = app.pane.prompt.query_one("Input").value  # type: ignore[attr-defined]
        assert Path(proposed).parent == tmp_path
        path = tmp_path / "new" / "my.log"
        await answer(pilot, path)
        assert len(path.read_text(encoding="utf-8").splitlines()) == 100
        path.write_text("mine", encoding="utf-8")
        app.pane.save()
        await answer(pilot, path)
        assert path.read_text(encoding="utf-8") == "mine"
        assert "Enter again to overwrite" in remark(app)
        await answer(pilot, path)
        assert path.read_text(encoding="utf-8").endswith("line 100\n")
        assert app.pane.view.has_focus


ALPHABET = st.sampled_from("ab ё—\u0301你🧠\ufe0f\u200d🎙")


@example("\u200daaa🧠🧠🧠", 8)
@example("\u200d\u200d" + "a" * 10 + "🧠", 8)
@given(st.text(ALPHABET, max_size=60), st.integers(8, 20))
def test_folding_keeps_every_character_and_no_row_is_too_wide(text: str, width: int) -> None:
    pieces = folded(text, width)
    assert "".join(pieces) == text
    assert all(cell_len(piece.removesuffix(" ")) <= width for piece in pieces)
    assert folded_rows(text, width) == len(pieces)


def said(node: str, seq: int, text: str = "hello", severity: Severity = Severity.INFO) -> LogLine:
    return LogLine(node, seq, 1_700_000_000.0 + seq, severity, text)


def filled(ring: LineRing, node: str, first: int, count: int, text: str = "hello") -> None:
    ring.append([said(node, seq, text) for seq in range(first, first + count)], {})
    if ring.full:
        ring.trim()


def test_a_flood_of_one_node_leaves_the_lines_of_the_others() -> None:
    ring = LineRing(max_lines=1000)
    filled(ring, "quiet", 1, 50)
    for batch in range(40):
        filled(ring, "noisy", 1 + batch * 500, 500)
    kept = Counter(entry.node for entry in ring.entries)
    assert kept["quiet"] == 50
    assert len(ring.entries) <= 1250
    assert ring.entries[-1].text == "hello"


def test_what_somebody_reads_is_not_dropped_and_the_gap_behind_it_is_marked() -> None:
    ring = LineRing(max_lines=100)
    filled(ring, "noisy", 1, 100)
    read = list(ring.entries)
    ring.hold()
    for batch in range(10):
        filled(ring, "noisy", 101 + batch * 100, 100)
    assert ring.entries[:100] == read
    assert len(ring.entries) <= 100 + 126
    mark = ring.entries[100]
    assert mark.skipped == 1000 - (len(ring.entries) - 101)
    ring.release()
    ring.trim()
    assert len(ring.entries) == 100
    assert ring.entries[-1].id == 1099
