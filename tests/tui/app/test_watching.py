"""A running robot without a profile: looked at, stopped only by the emergency stop, left alone."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

from textual.pilot import Pilot
from textual.widgets import Static

from graph.data import GraphUpdate, NodeRow
from tests.tui.recorded import (
    NOW_S,
    TOPICS,
    RecordedGraph,
    RecordedOpener,
    lesson_samples,
    lesson_update,
    sample,
)
from tests.tui.recorded_lesson import topic
from tests.tui.snapshots import Look, settle
from tui import clock
from tui.app import DeckApp
from tui.deck.screen import LessonDeck
from tui.session.ports import SessionLink
from tui.session.requests import OpenRequest, WatchRequest
from tui.session.watching import WATCH, watched

NOTHING = lesson_update(topics=(), samples={}, nodes=(), services=())


def rosout(text: str, node: str = "talker", level: int = 20, at_s: int = 0) -> Any:
    stamp = {"sec": int(NOW_S) + at_s, "nanosec": 0}
    return sample(
        "/rosout",
        "rcl_interfaces/msg/Log",
        {"stamp": stamp, "level": level, "name": node, "msg": text},
    )


def robot() -> GraphUpdate:
    """Lesson 9, started by somebody else."""
    lines = tuple(
        rosout(text, node, level, at_s)
        for at_s, (node, level, text) in enumerate(
            (
                ("sonar_front", 20, "Distance: 1.84 m"),
                ("safety_stop", 30, "Obstacle at 0.38 m: wheels are held"),
                ("ai_brain", 20, "The brain is awake and waits for a voice"),
            )
        )
    )
    return lesson_update(samples={**lesson_samples(), "/rosout": lines})


class WatchingOpener(RecordedOpener):
    """Opens a robot that is only looked at."""

    async def open(self, order: OpenRequest) -> SessionLink:
        await super().open(order)
        return watched(42)


def opener_of(update: GraphUpdate) -> RecordedOpener:
    return WatchingOpener(graph=RecordedGraph(update))


def app_of(look: Look, watching: RecordedOpener) -> DeckApp:
    app = look.app("deck", watching)
    return DeckApp(watching, OpenRequest(watch=WatchRequest(42)), app._first_screen)


@asynccontextmanager
async def watching(update: GraphUpdate) -> AsyncIterator[tuple[Pilot[Any], RecordedGraph]]:
    opener = opener_of(update)
    app = app_of(Look((120, 40), "en"), opener)
    async with app.run_test(size=(120, 40)) as pilot:
        await settle(pilot)
        yield pilot, opener.graph


def deck_of(pilot: Pilot[Any]) -> LessonDeck:
    assert isinstance(pilot.app.screen, LessonDeck)
    return pilot.app.screen


def words_of(pilot: Pilot[Any]) -> str:
    return str(pilot.app.screen.query_one("#watched", Static).render())


async def test_it_says_that_deck_has_started_nothing_and_who_runs() -> None:
    async with watching(robot()) as (pilot, _graph):
        assert "Deck has started nothing here" in words_of(pilot)
        assert "8 nodes run here: ai_brain" in words_of(pilot)


async def test_an_empty_domain_says_so() -> None:
    async with watching(NOTHING) as (pilot, _graph):
        assert "Start a node with ROS_DOMAIN_ID=42" in words_of(pilot)


async def test_panels_come_with_their_topics_and_stay() -> None:
    async with watching(NOTHING) as (pilot, graph):
        deck = deck_of(pilot)
        assert not deck.panels
        sonar = topic("/sensor/sonar_front", "std_msgs/msg/Float32", 1.0)
        graph.show(lesson_update(topics=(sonar,), samples={}))
        await pilot.pause()
        await pilot.pause()
        assert [type(panel).__name__ for panel in deck.panels] == ["SonarPanel"]
        graph.show(lesson_update(topics=TOPICS))
        await pilot.pause()
        await pilot.pause()
        assert len(deck.panels) == 5
        graph.show(NOTHING)
        await pilot.pause()
        assert len(deck.panels) == 5


async def test_what_nodes_say_on_rosout_is_the_log() -> None:
    async with watching(robot()) as (pilot, graph):
        assert "/rosout" in graph.followed
        lines = [line.text for line in pilot.app.feed.history.all()]  # type: ignore[attr-defined]
        assert "Obstacle at 0.38 m: wheels are held" in lines
        await pilot.press("4")
        await pilot.pause()
        assert len(pilot.app.screen.pane.view.ring.entries) == 3  # type: ignore[attr-defined]


async def test_nothing_can_be_started_or_stopped_and_leaving_stops_nothing() -> None:
    async with watching(robot()) as (pilot, graph):
        await pilot.press("X", "S", "R", "s", "x")
        assert pilot.app.feed.watching  # type: ignore[attr-defined]
        await pilot.press("q")
        await pilot.pause()
        assert pilot.app.return_code == 0
        assert not graph.published


async def test_the_emergency_stop_is_published_as_always() -> None:
    async with watching(robot()) as (pilot, graph):
        await pilot.press("space")
        await pilot.pause()
        assert ("/emergency_stop", {"data": True}) in [
            (published[0], published[2]) for published in graph.published
        ]


async def test_the_picker_s_first_row_looks_at_the_domain() -> None:
    opener = opener_of(robot())
    app = DeckApp(opener, OpenRequest())
    async with app.run_test(size=(120, 40)) as pilot:
        await settle(pilot)
        await pilot.press("home", "enter")
        await settle(pilot)
        assert opener.orders[0].watch == WatchRequest(42)
        assert app.feed.session is not None
        assert app.feed.session.run_id == WATCH


def test_who_was_there_and_is_not_seen_any_more_is_not_told_as_never_come() -> None:
    from tui.deck.watched import Watched

    near, far = Watched(42), Watched(42, beyond=True)
    for one in (near, far):
        one.words(lesson_update(nodes=(NodeRow("/a"),), time_s=NOW_S))
    gone = lesson_update(nodes=(), time_s=NOW_S + 1)
    assert near.words(gone) == f"Nobody is seen any more since {clock.time_of_day(NOW_S + 1)}."
    assert "the network may be down" in far.words(gone)
    later = lesson_update(nodes=(), time_s=NOW_S + 90)
    assert far.words(later) == far.words(gone)
    assert "1 node runs here" in far.words(lesson_update(nodes=(NodeRow("/a"),)))
