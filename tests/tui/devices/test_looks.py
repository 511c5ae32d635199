"""How the Devices screen looks, at three sizes and in both languages."""

from __future__ import annotations

import time
from collections.abc import Awaitable, Callable, Iterator
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Static

from graph.data import Sample
from tests.tui.recorded import RecordedGraph, RecordedOpener, RecordedSession
from tests.tui.recorded_devices import (
    AGGREGATED,
    STATUSES,
    of_chassis,
    of_sonar,
    reported,
    update,
    with_drivers,
)
from tests.tui.snapshots import Look, SnapCompare, every_look, one_look, settle
from tests.waiting import until
from tui.app import DeckApp
from tui.devices import words as devices_words
from tui.devices.diagnostics import DiagnosticsTree
from tui.devices.screen import DevicesScreen

Before = Callable[[Pilot[Any]], Awaitable[None]]


@pytest.fixture(autouse=True)
def _utc(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Times of day are those of the recording, and the same lessons have drivers for ever."""
    monkeypatch.setenv("TZ", "UTC")
    monkeypatch.setattr(devices_words, "_lessons_with_drivers", lambda: ("robot",))
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


def shown(*samples: Sample, keys: tuple[str, ...] = ()) -> Before:
    """Press keys, then let drivers say this."""

    async def before(pilot: Pilot[Any]) -> None:
        await settle(pilot)
        await pilot.press(*keys)
        assert isinstance(pilot.app, DeckApp)
        graph = pilot.app.feed.graph
        assert isinstance(graph, RecordedGraph)
        graph.show(update(*STATUSES, *samples))
        for _round in range(4):
            await pilot.pause()

    return before


@every_look
def test_frames_of_the_chassis(look: Look, snap_compare: SnapCompare) -> None:
    """Four drivers, each with its state; drive lines out and telemetry in, noise and a bad line."""
    before = shown(of_chassis(language=look.language))
    assert snap_compare(
        look.app("devices", with_drivers()), terminal_size=look.size, run_before=before
    )


@one_look
def test_frames_of_a_sonar(look: Look, dump_compare: SnapCompare) -> None:
    """The second driver is chosen; the bytes are in a column of their own."""
    metres = (1.23, 1.24, 9.0, 0.1, 1.25)
    before = shown(of_sonar(*metres, language=look.language), keys=("down", "down"))
    assert dump_compare(
        look.app("devices", with_drivers()), terminal_size=look.size, run_before=before
    )


@every_look
def test_diagnostics(look: Look, dump_compare: SnapCompare) -> None:
    """The worst on top, a branch like the worst in it; of the lidar its changes and values."""

    async def before(pilot: Pilot[Any]) -> None:
        await shown(*AGGREGATED, keys=("right",))(pilot)
        assert isinstance(pilot.app, DeckApp)
        screen, graph = pilot.app.screen, pilot.app.feed.graph
        assert isinstance(screen, DevicesScreen)
        assert isinstance(graph, RecordedGraph)
        for level, message in ((2, "no data"), (1, "12 % of the points are missing")):
            graph.show(update(reported("/sensors/lidar", level, message, rate="9.8")))
            await pilot.pause()
        screen._look()
        screen.query_one(DiagnosticsTree).choose("sensors/lidar")
        for _round in range(3):
            await pilot.pause()

    assert dump_compare(
        look.app("devices", with_drivers()), terminal_size=look.size, run_before=before
    )


@one_look
def test_an_unplugged_device(look: Look, dump_compare: SnapCompare) -> None:
    """Why nothing comes from the last driver, with the fix."""
    before = shown(keys=("end",))
    assert dump_compare(
        look.app("devices", with_drivers()), terminal_size=look.size, run_before=before
    )


@one_look
def test_a_lesson_without_drivers(look: Look, dump_compare: SnapCompare) -> None:
    """Says that there are none, and which profile has them."""
    nobody = RecordedOpener(RecordedSession(lines=()), RecordedGraph(update(publishers=())))
    app = look.app("devices", nobody)

    async def before(pilot: Pilot[Any]) -> None:
        await settle(pilot)
        empty = pilot.app.screen.query_one("#devices-empty", Static)
        await until(lambda: "robot" in str(empty.render()), "the profile that has them")
        await pilot.pause()

    assert dump_compare(app, terminal_size=look.size, run_before=before)
