"""The Logs screen: all nodes, chosen ones, searched, and the keys for it in both alphabets."""

from __future__ import annotations

from typing import Any

from textual.pilot import Pilot

from launcher.events import LogEvent
from tests.tui.recorded import LINES, RecordedOpener, RecordedSession, line
from tests.tui.snapshots import Look, settle
from tui.frame.key_bar import KeyBar
from tui.log_view.pane import LogBar
from tui.logs.screen import LogsScreen

HOME = Look((120, 40), "en")


def screen_of(pilot: Pilot[Any]) -> LogsScreen:
    screen = pilot.app.screen
    assert isinstance(screen, LogsScreen)
    return screen


def nodes_shown(screen: LogsScreen) -> set[str]:
    return {entry.node for entry in screen.pane.view.index.shown}


async def test_opened_late_it_has_every_line_and_misses_none_behind_another() -> None:
    session = RecordedSession()
    async with HOME.app("deck", RecordedOpener(link=session)).run_test(size=HOME.size) as pilot:
        await settle(pilot)
        await pilot.press("4")
        await pilot.pause()
        entries = screen_of(pilot).pane.view.ring.entries
        assert [entry.text for entry in entries] == [one.text for one in LINES]
        await pilot.press("1")
        session.say(LogEvent((line("audio", 2, "while away"),), {}))
        await pilot.pause()
        await pilot.press("4")
        await pilot.pause()
        assert screen_of(pilot).pane.view.ring.entries[-1].text == "while away"


async def test_the_key_that_pauses_is_called_by_what_it_does_now() -> None:
    async with HOME.app("logs").run_test(size=HOME.size) as pilot:
        await settle(pilot)
        bar = screen_of(pilot).query_one(KeyBar)
        assert "p Pause" in bar.render().plain
        await pilot.press("p")
        assert "p Resume" in bar.render().plain
        await pilot.press("p")
        assert "p Pause" in bar.render().plain


async def test_mute_and_only_this_work_on_the_row_of_the_list() -> None:
    async with HOME.app("logs").run_test(size=HOME.size) as pilot:
        await settle(pilot)
        screen, (go, mute, only) = screen_of(pilot), "Iьo"
        everybody = nodes_shown(screen)
        await pilot.press(go, mute)
        assert nodes_shown(screen) == everybody - {"sonar_front"}
        await pilot.press("down", only)
        assert nodes_shown(screen) == {"camera"}
        assert "only camera" in screen.query_one(LogBar).words
        await pilot.press(only)
        assert nodes_shown(screen) == everybody - {"sonar_front"}
        await pilot.press("a")
        assert nodes_shown(screen) == everybody


async def test_in_the_search_field_letters_and_space_are_text() -> None:
    app = HOME.app("logs")
    async with app.run_test(size=HOME.size) as pilot:
        await settle(pilot)
        screen = screen_of(pilot)
        await pilot.press("slash")
        await pilot.pause()
        await pilot.press(*"way", "space", *"is")
        assert screen.pane.view.log_filter.search == "way is"
        assert len(screen.pane.view.index.found) == 2
        assert not app.emergency.state.engaged
        await pilot.press("enter", "f")
        assert len(screen.pane.view.index.shown) == 2
        await pilot.press("f", "N")
        assert screen.pane.view.choice.found_number == 1
