"""What the Devices screen does: it hears every driver, shows frames, filters, pauses, copies."""

from __future__ import annotations

from contextlib import AbstractAsyncContextManager
from pathlib import Path

import pytest
from textual.widgets import Static

from graph.data import Sample
from tests.tui.recorded import RecordedGraph, RecordedOpener, RecordedSession
from tests.tui.recorded_devices import (
    AT_S,
    of_chassis,
    of_sonar,
    status,
    update,
    with_drivers,
)
from tests.tui.screen_stage import ScreenStage, on_stage
from tests.waiting import until
from tui import clock
from tui.devices import words as devices_words
from tui.devices.diagnostics import DiagnosticsView, StatusFacts
from tui.devices.screen import DevicesScreen
from tui.frame.key_bar import KeyBar
from tui.widgets.tab_line import TabLine


class DevicesStage(ScreenStage[DevicesScreen]):
    """The screen with its recorded drivers."""

    name, kind = "devices", DevicesScreen

    async def hear(self, *samples: Sample) -> None:
        await self.show(update(*samples))

    def drivers(self) -> list[str]:
        """The rows of the table, without blanks at the ends."""
        table = self.screen.table
        height = table.size.height
        return [row for y in range(1, height) if (row := table.render_line(y).text.strip())]

    def lines(self) -> list[str]:
        """The frames that the filter lets through."""
        return [entry.text for entry in self.screen.pane.view.index.shown]

    def whole(self) -> str:
        return str(self.screen.query_one("#devices-chosen", Static).render())

    def empty(self) -> str:
        return str(self.screen.query_one("#devices-empty", Static).render())


def stage(of: RecordedOpener | None = None) -> AbstractAsyncContextManager[DevicesStage]:
    return on_stage(DevicesStage, of or with_drivers())


async def test_every_driver_has_a_row_though_all_speak_on_one_topic() -> None:
    async with stage() as at:
        rows = at.drivers()
        assert [row.removeprefix("▶ ").split("  ")[0] for row in rows] == [
            "chassis", "imu: data", "sonar_front", "sonar_rear",
        ]  # fmt: skip
        assert "▲ warning" in rows[0]
        assert "1\N{NO-BREAK SPACE}290" in rows[0]
        assert "✗ error" in rows[3]
        assert "no link" in rows[3]
        await at.hear(status("sonar_rear", 0, "back again"))
        assert "back again" in at.drivers()[3]
        assert "The wheels stand" in at.drivers()[0]


async def test_frames_are_asked_for_of_the_chosen_driver_and_only_while_shown() -> None:
    async with stage() as at:
        assert {"/diagnostics", "/chassis/frames"} <= at.graph.followed
        await at.press("down", "down")
        assert "/chassis/frames" not in at.graph.followed
        assert "/sonar_front/frames" in at.graph.followed
        await at.hear(of_chassis())
        assert at.lines() == []
        await at.hear(of_sonar(1.23))
        assert [line.split("  ")[0] for line in at.lines()] == [
            "distance 1.23 m, strength 1000, 30.0 °C"
        ]
        await at.press("1")
        assert not {"/diagnostics", "/sonar_front/frames"} & at.graph.followed
        await at.press("7")
        assert {"/diagnostics", "/sonar_front/frames"} <= at.graph.followed


async def test_frames_both_ways_with_noise_and_a_bad_one() -> None:
    async with stage() as at:
        await at.hear(of_chassis())
        lines = at.lines()
        assert len(lines) == 17
        assert lines[0].split("  ")[0].startswith("drive left 3.20 right 3.40 rad/s")
        assert lines[0].endswith("$D,17,3200,3400,100*3CC7")
        assert lines[9].startswith("~ noise 2 bytes")
        assert lines[10].startswith("✗ CRC FAILED")
        await at.press("v")
        assert at.lines()[0].endswith("33 43 43 37 0A")
        assert at.lines()[9].endswith("FF 00")
        await at.press("v")
        assert at.lines() == lines
        await at.press("f9")
        await at.pilot.pause()
        assert "▲ внимание" in at.whole()
        assert {entry.node for entry in at.screen.pane.view.index.shown} == {"← вх", "→ исх"}


async def test_filter_pause_and_clear() -> None:
    async with stage() as at:
        await at.hear(of_chassis())
        await at.press("b")
        assert not any("drive" in line for line in at.lines())
        await at.press("и")
        assert all("drive" in line for line in at.lines())
        await at.press("b", "а")
        assert [line[:2] for line in at.lines()] == ["~ ", "✗ "]
        await at.press("f", "p")
        await at.hear(of_chassis())
        assert not at.screen.pane.view.following
        assert at.screen.pane.view.fresh == 17
        assert "Resume" in at.screen.query_one(KeyBar).render().plain
        await at.press("з", "в")
        assert at.lines() == []


async def test_lines_are_copied_and_written_to_a_file(tmp_path: Path) -> None:
    async with stage() as at:
        await at.hear(of_sonar(1.23), of_chassis(1))
        await at.press("tab", "up", "y")
        assert "wheels left 3.10" in at.app.clipboard
        assert "← in" in at.app.clipboard
        await at.press("W")
        field = at.screen.pane.prompt.query_one("Input")
        field.value = str(tmp_path / "frames.log")  # type: ignore[attr-defined]
        await at.press("enter")
        await until(lambda: not at.screen.pane.prompt.kind, "the file written")
        assert "drive left 3.20" in (tmp_path / "frames.log").read_text()
        await at.press("escape")
        assert at.screen.table.has_focus


async def test_why_nothing_comes_from_a_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    async with stage() as at:
        view = at.screen.pane.view
        assert "Listening on /chassis/frames" in view.empty_words
        await at.press("down")
        assert "does not publish …/imu: data/frames" in view.empty_words
        await at.press("end")
        assert "Nothing is connected" in view.empty_words
        assert "no such port; plug it in" in at.whole()
        await at.press("home")
        monkeypatch.setattr(clock, "now", lambda: AT_S + 5.0)
        await at.hear(status("sonar_front"))
        rows = at.drivers()
        assert "○ stale 5 s" in rows[0]
        assert "chassis has said nothing for 5 s" in at.screen.pane.view.empty_words
        await at.press("1", "7")
        assert "▲ warning" in at.drivers()[0], "nobody listened in between"


async def test_why_there_is_no_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(devices_words, "_lessons_with_drivers", lambda: ("robot",))
    lesson = RecordedOpener(RecordedSession(lines=()), RecordedGraph(update(publishers=())))
    async with stage(lesson) as at:
        await until(lambda: "Drivers run in: robot." in at.empty(), "the lesson with drivers")
        assert "No driver says anything on /diagnostics." in at.empty()
    starting = with_drivers()
    starting.graph.update = update(publishers=())
    async with stage(starting) as at:
        assert "chassis, sonar_front have not said anything" in at.empty()


async def test_the_second_tab_has_what_everybody_says_the_worst_on_top() -> None:
    async with stage() as at:
        await at.press("right")
        view = at.screen.query_one(DiagnosticsView)
        assert at.screen.focused is view.names
        first, second, *_ = (row.cells[0].text for row in view.names._rows)
        assert first.startswith("✗ sonar_rear  Cannot open ")
        assert second == "▲ chassis  The wheels stand: no drive line for 250 ms"
        # The frames of a driver are not asked for while nobody sees them.
        assert at.graph.followed >= {"/diagnostics"}
        assert not any("frames" in topic for topic in at.graph.followed)
        await at.press("left")
        assert not at.screen.shows_tree
        assert any("frames" in topic for topic in at.graph.followed)


async def test_silence_makes_stale_and_stands_in_the_history(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with stage() as at:
        await at.press("right")
        view = at.screen.query_one(DiagnosticsView)
        view.names.choose("chassis")
        later_s = clock.now() + 6.0
        monkeypatch.setattr(clock, "now", lambda: later_s)
        await until(
            lambda: "▲" not in str(at.screen.query_one(TabLine).render()), "the tab is calm"
        )
        facts = at.screen.query_one(StatusFacts)
        await until(lambda: len(facts._rows) > 2 and "stale" in facts._rows[1].cells[0].text, "it")
        assert "warning" in facts._rows[2].cells[0].text
