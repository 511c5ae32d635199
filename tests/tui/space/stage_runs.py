"""The Space screen at work with a recorded robot, for tests that press its keys."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

from textual.pilot import Pilot

from graph.data import GraphUpdate
from tests.tui.recorded import RecordedGraph, RecordedOpener, RecordedSession
from tests.tui.recorded_map import MAP_SESSION
from tests.tui.recorded_space import space_update
from tests.tui.snapshots import opened
from tui.app import DeckApp
from tui.space.screen import SpaceScreen


def robot_in_a_room(update: GraphUpdate | None = None) -> RecordedOpener:
    """The simulated robot on its way, with a lidar and a depth camera."""
    graph = RecordedGraph(update or space_update())
    return RecordedOpener(RecordedSession(MAP_SESSION, lines=()), graph)


@asynccontextmanager
async def at_work(
    opener: RecordedOpener | None = None, size: tuple[int, int] = (120, 40)
) -> AsyncIterator[tuple[SpaceScreen, Pilot[Any]]]:
    """Run the app until the robot is on the screen."""
    async with opened(opener or robot_in_a_room(), "space", size) as (app, pilot):
        await pilot.pause()
        yield shown(app), pilot


def shown(app: DeckApp) -> SpaceScreen:
    assert isinstance(app.screen, SpaceScreen)
    return app.screen
