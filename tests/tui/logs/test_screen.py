"""The Logs screen: all nodes, chosen ones, searched, and the keys for it in both alphabets."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import pytest
from textual.pilot import Pilot

from graph.data import GraphUpdate, NodeRow
from launcher.events import LogEvent
from launcher.status import Severity
from tests.tui.recorded import LINES, RecordedGraph, RecordedOpener, RecordedSession, line
from tests.tui.recorded_nodes import graph_update
from tests.tui.snapshots import Look, settle
from tests.waiting import until
from tui.dialogs.choice import ChoiceScreen
from tui.frame.key_bar import KeyBar
from tui.log_level import full_name
from tui.log_view.bar import LogBar
from tui.logs.screen import LogsScreen

HOME = Look((120, 40), "en")


@pytest.fixture(autouse=True)
def _utc(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Times of day are those of the recording."""
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


def screen_of(pilot: Pilot[Any]) -> LogsScreen:
    screen = pilot.app.screen
    assert isinstance(screen, LogsScreen)
    return screen


def nodes_shown(screen: LogsScreen) -> set[str]:
    return {entry.node for entry in screen.pane.view.index.shown}


async def test_opened_late_it_has_every_line_once() -> None:
    async with HOME.app("deck").run_test(size=HOME.size) as pilot:
        await settle(pilot)
        await pilot.press("4")
        await pilot.pause()
        entries = screen_of(pilot).pane.view.ring.entries
        assert [entry.text for entry in entries] == [one.text for one in LINES]


async def test_lines_that_come_are_appended_whatever_screen_is_in_front() -> None:
    session = RecordedSession()
    async with HOME.app("logs", RecordedOpener(link=session)).run_test(size=HOME.size) as pilot:
        await settle(pilot)
        screen = screen_of(pilot)
        await pilot.press("1")
        session.say(LogEvent((line("audio", 2, "while away"),), {}))
        await pilot.pause()
        await pilot.press("4")
        await pilot.pause()
        assert screen.pane.view.ring.entries[-1].text == "while away"


async def test_the_key_that_pauses_is_called_by_what_it_does_now() -> None:
    async with HOME.app("logs").run_test(size=HOME.size) as pilot:
        await settle(pilot)
        bar = screen_of(pilot).query_one(KeyBar)
        assert "p Pause" in bar.render().plain
        await pilot.press("p")
        assert "p Resume" in bar.render().plain
        await pilot.press("p")
        assert "p Pause" in bar.render().plain


@pytest.mark.parametrize("keys", ["Imo", "Шьщ"])
async def test_mute_and_only_this_work_on_the_row_of_the_list(keys: str) -> None:
    async with HOME.app("logs").run_test(size=HOME.size) as pilot:
        await settle(pilot)
        screen, (go, mute, only) = screen_of(pilot), tuple(keys)
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


async def test_the_level_of_the_chosen_lines_node_is_changed() -> None:
    graph = RecordedGraph(update=graph_update())
    app = HOME.app("logs", RecordedOpener(graph=graph))
    async with app.run_test(size=HOME.size) as pilot:
        await settle(pilot)
        await pilot.press("up", "K")
        await until(lambda: isinstance(pilot.app.screen, ChoiceScreen), "the dialog")
        await pilot.press("down", "enter")
        node = f"/{LINES[-1].node}"
        await until(lambda: graph.inner.levels == {node: "warn"}, "the level")
        await until(
            lambda: [one.message for one in app._notifications] == [f"{node} logs from warn on"],
            "what was done",
        )


def test_a_name_in_the_log_leads_to_the_node_in_its_namespace() -> None:
    rows = (NodeRow("/arm/gripper"), NodeRow("/leg/gripper"), NodeRow("/arm/wrist"))
    update = GraphUpdate(0.0, nodes=rows)
    assert full_name(update, "arm/gripper") == "/arm/gripper"
    assert full_name(update, "/leg/gripper") == "/leg/gripper"
    assert full_name(update, "arm.wrist") == "/arm/wrist"
    assert full_name(update, "wrist") == "/arm/wrist"
    assert full_name(update, "gripper") == "/gripper"
    assert full_name(None, "gripper") == "/gripper"


async def test_each_press_leaves_out_one_severity_more() -> None:
    async with HOME.app("logs").run_test(size=HOME.size) as pilot:
        await settle(pilot)
        screen = screen_of(pilot)
        await pilot.press("F", "F")
        assert {entry.rank for entry in screen.pane.view.index.shown} == {
            Severity.WARN.rank,
            Severity.ERROR.rank,
        }
        assert "WARN and worse" in screen.query_one(LogBar).words


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
