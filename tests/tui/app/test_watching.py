"""A running robot without a profile: looked at, stopped only by the emergency stop, left alone."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

from textual.pilot import Pilot
from textual.widgets import Static

from graph.data import GraphUpdate
from graph.observer.requests import Publish
from tests.tui.recorded import TOPICS, RecordedGraph, RecordedOpener, lesson_update
from tests.tui.recorded_lesson import topic
from tests.tui.snapshots import settle
from tui.app import DeckApp
from tui.deck.screen import LessonDeck
from tui.session.ports import SessionLink
from tui.session.requests import OpenRequest, WatchRequest
from tui.session.watching import WATCH, watched

NOTHING = lesson_update(topics=(), samples={}, nodes=(), services=())


class WatchingOpener(RecordedOpener):
    """Opens a robot that is only looked at."""

    async def open(self, order: OpenRequest) -> SessionLink:
        await super().open(order)
        return watched(42)


@asynccontextmanager
async def watching(update: GraphUpdate) -> AsyncIterator[tuple[DeckApp, Pilot[Any], RecordedGraph]]:
    graph = RecordedGraph(update)
    app = DeckApp(WatchingOpener(graph=graph), OpenRequest(watch=WatchRequest(42)))
    async with app.run_test(size=(120, 40)) as pilot:
        await settle(pilot)
        yield app, pilot, graph


async def test_it_says_that_deck_has_started_nothing_and_who_runs() -> None:
    async with watching(lesson_update()) as (app, _pilot, _graph):
        words = str(app.screen.query_one("#watched", Static).render())
        assert "Deck has started nothing here" in words
        assert "8 nodes run here: ai_brain" in words


async def test_panels_come_with_their_topics_and_stay() -> None:
    async with watching(NOTHING) as (app, pilot, graph):
        assert isinstance(app.screen, LessonDeck)
        sonar = topic("/sensor/sonar_front", "std_msgs/msg/Float32", 1.0)
        for update, count in (
            (NOTHING, 0),
            (lesson_update(topics=(sonar,), samples={}), 1),
            (lesson_update(topics=TOPICS), 5),
            (NOTHING, 5),
        ):
            graph.show(update)
            await settle(pilot)
            assert len(app.screen.panels) == count


async def test_nothing_can_be_started_or_stopped_and_leaving_stops_nothing() -> None:
    async with watching(lesson_update()) as (app, pilot, graph):
        await pilot.press("X", "S", "R", "s", "x")
        assert app.feed.watching
        await pilot.press("q")
        await pilot.pause()
        assert app.return_code == 0
        assert not graph.asked(Publish)


async def test_the_emergency_stop_is_published_as_always() -> None:
    async with watching(lesson_update()) as (_app, pilot, graph):
        await pilot.press("space")
        await pilot.pause()
        assert graph.asked(Publish)[0][0] == "/emergency_stop"
        assert graph.asked(Publish)[0][2] == {"data": True}


async def test_the_picker_s_first_row_looks_at_the_domain() -> None:
    opener = WatchingOpener()
    app = DeckApp(opener, OpenRequest())
    async with app.run_test(size=(120, 40)) as pilot:
        await settle(pilot)
        await pilot.press("home", "enter")
        await settle(pilot)
        assert opener.orders[0].watch == WatchRequest(42)
        assert app.feed.session is not None
        assert app.feed.session.run_id == WATCH
