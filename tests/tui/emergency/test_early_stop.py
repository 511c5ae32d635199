"""A stop pressed before anybody can obey it: kept, shown, and given to the first who can."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pytest
from textual.pilot import Pilot

from graph.observer.requests import Publish
from launcher.errors import UsageError
from launcher.status import NodeState
from safety.topics import EMERGENCY_STOP
from tests.tui.recorded import NODES, NOW_S, TOPICS, RecordedGraph, RecordedOpener, RecordedSession, lesson_update
from tests.tui.recorded_emergency import GATE, obeyed, word
from tests.tui.snapshots import LESSON_9, opened, settle
from tests.waiting import until
from text.i18n import set_language
from tui.app import DeckApp
from tui.emergency import control
from tui.emergency.state import TOPIC_TYPE
from tui.frame.actions.app import emergency_stop
from tui.frame.key_bar import KeyBar
from tui.frame.title_bar import TitleBar
from tui.session.ports import SessionLink
from tui.session.requests import OpenRequest

STOP = (EMERGENCY_STOP, TOPIC_TYPE, {"data": True}, True)
DEAF = tuple(row for row in TOPICS if row.name != EMERGENCY_STOP)
WAITS = "■ EMERGENCY STOP · waits for the first node that can obey"


@dataclass
class SlowOpener(RecordedOpener):
    """Opens the recorded session once the test lets it."""

    begun: asyncio.Event = field(default_factory=asyncio.Event)

    async def open(self, order: OpenRequest) -> SessionLink:
        await self.begun.wait()
        return await super().open(order)


def starting() -> RecordedSession:
    nodes = {name: replace(node, state=NodeState.STARTING) for name, node in NODES.items()}
    return RecordedSession(nodes=nodes)


def deaf() -> RecordedGraph:
    """A graph in which nobody listens to the stop."""
    return RecordedGraph(lesson_update(topics=DEAF))


async def shows(app: DeckApp, words: str) -> None:
    """Wait until the title says this."""
    await until(lambda: words in app.screen.query_one(TitleBar).text, lambda: app.screen.query_one(TitleBar).text)


async def is_on(app: DeckApp, pilot: Pilot[Any]) -> None:
    """Wait until the screen of the session is in front."""
    await until(lambda: app.screen.query(KeyBar), "the screen")
    await pilot.pause()


@pytest.mark.parametrize("key", ["space", "ctrl+x"])
async def test_a_stop_pressed_while_a_profile_opens_waits_and_is_given_when_it_is_open(key: str) -> None:
    opener = SlowOpener()
    app = DeckApp(opener, LESSON_9, "deck")
    async with app.run_test(size=(120, 40)) as pilot:
        await is_on(app, pilot)
        assert "space STOP" in str(app.screen.query_one(KeyBar).render())
        await pilot.press(key)
        await shows(app, WAITS)
        assert app.screen.query_one(TitleBar).has_class("-stop")
        opener.begun.set()
        await settle(pilot)
        await shows(app, "pressed, nobody has confirmed it")
        assert set(map(repr, opener.graph.asked(Publish))) == {repr(STOP)}
        assert set(opener.link.stops) == {True}
        at_s = app.emergency.state.asked_s + 1.0
        opener.graph.show(obeyed(word(GATE, True, at_s, since_s=at_s), at_s=at_s))
        await until(lambda: not app.emergency.state.unconfirmed, "its confirmation")
        assert ("stop",) not in opener.link.asked


async def test_what_is_released_before_it_is_open_is_not_given() -> None:
    opener = SlowOpener()
    app = DeckApp(opener, LESSON_9, "deck")
    async with app.run_test(size=(120, 40)) as pilot:
        await is_on(app, pilot)
        await pilot.press("space")
        await shows(app, WAITS)
        await pilot.press("ctrl+r")
        await shows(app, "opening 09-brain")
        opener.begun.set()
        await settle(pilot)
        assert opener.graph.asked(Publish) == []
        assert opener.link.stops == []
        assert not app.emergency.state.engaged


async def test_while_nodes_start_of_which_none_listens_yet_none_is_ended() -> None:
    opener = RecordedOpener(link=starting(), graph=deaf())
    async with opened(opener) as (app, pilot):
        await pilot.press("space")
        await shows(app, WAITS)
        opener.graph.show(lesson_update(time_s=NOW_S + 1))
        await until(lambda: opener.graph.asked(Publish) == [STOP, STOP], "the stop, given once more")
        await shows(app, "pressed, nobody has confirmed it")
        assert opener.link.stops == [True]
        assert ("stop",) not in opener.link.asked


async def test_where_none_listens_once_all_have_started_they_are_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(control, "SEEN_WITHIN_S", 0.0)
    opener = RecordedOpener(link=starting(), graph=deaf())
    async with opened(opener) as (app, pilot):
        await pilot.press("space")
        await shows(app, WAITS)
        for name in opener.link.nodes:
            opener.link.set_state(name, NodeState.READY)
        await until(lambda: ("stop",) in opener.link.asked, "the nodes to be ended")
        await shows(app, "nobody listens")


async def test_it_does_not_wait_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a node that never gets ready nobody knows what it does meanwhile."""
    monkeypatch.setattr(control, "OPENED_WITHIN_S", 0.0)
    opener = RecordedOpener(link=starting(), graph=deaf())
    async with opened(opener) as (_app, pilot):
        await pilot.press("space")
        await until(lambda: ("stop",) in opener.link.asked, "the nodes to be ended")


async def test_released_while_it_waits_it_ends_no_node() -> None:
    opener = RecordedOpener(link=starting(), graph=deaf())
    async with opened(opener) as (app, pilot):
        await pilot.press("space")
        await shows(app, WAITS)
        await pilot.press("ctrl+r")
        await until(
            lambda: not [worker for worker in app.workers if worker.group == "emergency"], "the end of all waiting"
        )
        assert ("stop",) not in opener.link.asked
        assert not app.emergency.state.engaged


async def test_before_the_first_look_at_the_graph_nobody_knows_who_listens() -> None:
    opener = RecordedOpener(graph=RecordedGraph(None))
    app = DeckApp(opener, LESSON_9, "deck")
    async with app.run_test(size=(120, 40)) as pilot:
        await until(lambda: app.feed.link is not None, "the session")
        await pilot.press("space")
        await shows(app, WAITS)
        opener.graph.show(lesson_update())
        await shows(app, "pressed, nobody has confirmed it")
        assert ("stop",) not in opener.link.asked


async def test_what_could_not_be_opened_takes_its_stop_with_it() -> None:
    opener = SlowOpener(refusal=UsageError("the profile is broken"))
    async with opened(opener, "picker", order=OpenRequest()) as (app, pilot):
        assert not emergency_stop.possible(app), "nothing is being opened"
        app.sessions.open(OpenRequest(Path("profiles/09-brain.yaml")))
        await until(lambda: app.sessions.opening, "the opening")
        await is_on(app, pilot)
        await pilot.press("ctrl+x")
        assert app.emergency.state.engaged
        opener.begun.set()
        await until(lambda: not app.sessions.opening, "the refusal")
        await until(lambda: not app.emergency.state.engaged, "the end of the stop")


@pytest.mark.parametrize(
    ("language", "words"),
    [
        ("en", f"{WAITS} · ^r releases"),
        ("ru", "■ АВАРИЙНЫЙ СТОП · ждёт первого узла, который может его выполнить · ^r — снять"),
    ],
)
async def test_it_says_so_on_a_small_terminal(language: str, words: str) -> None:
    set_language(language)
    app = DeckApp(SlowOpener(), LESSON_9, "deck")
    async with app.run_test(size=(80, 24)) as pilot:
        await is_on(app, pilot)
        await pilot.press("space")
        await shows(app, words)
        assert "…" not in app.screen.query_one(TitleBar).text.splitlines()[-1]
