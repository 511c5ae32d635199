"""The emergency stop at work: at once, shown until released, and never without effect."""

from __future__ import annotations

import asyncio
import threading
import time
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import pytest
from textual.color import Color
from textual.events import Key
from textual.widgets import Input

from graph.observer.requests import ObserverError, Publish, Request, StopCommanding
from launcher.status import NodeState
from safety.stop_file import BY_SCREEN, StopFile
from safety.stop_record import Stop
from safety.topics import EMERGENCY_STOP, SAFETY_STATE
from tests.tui.recorded import NOW_S, TOPICS, RecordedGraph, RecordedOpener, RecordedSession, lesson_update, sample
from tests.tui.recorded_emergency import GATE, held, obeyed, said, word
from tests.tui.snapshots import opened, seen, settle
from text.i18n import set_language
from tui.deck.command_line import CommandLine
from tui.emergency import control
from tui.emergency.state import TOPIC_TYPE
from tui.frame import title
from tui.frame.key_bar import KeyBar
from tui.frame.title_bar import TitleBar
from tui.session.requests import OpenRequest

STOP = (EMERGENCY_STOP, TOPIC_TYPE, {"data": True}, True)
GO = (EMERGENCY_STOP, TOPIC_TYPE, {"data": False}, True)


@pytest.mark.parametrize("screen", ["deck", "topics", "logs"])
async def test_space_stops_at_once_on_every_screen(screen: str) -> None:
    opener = RecordedOpener()
    async with opened(opener, screen) as (app, pilot):
        await pilot.press("space")
        assert opener.graph.asked(Publish) == [STOP]
        title = app.screen.query_one(TitleBar)
        assert "■ EMERGENCY STOP · pressed, nobody has confirmed it · ^r releases" in title.text
        assert title.styles.background == Color.parse("#b00020")


async def test_the_stop_stays_until_it_is_released() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("space", "space", "escape", "2", "1")
        assert app.emergency.state.engaged
        assert GO not in opener.graph.asked(Publish)
        await pilot.press("ctrl+r")
        assert opener.graph.asked(Publish)[-1] == GO
        await pilot.pause()
        assert "EMERGENCY" not in app.screen.query_one(TitleBar).text


async def test_in_a_text_field_space_is_a_blank_and_ctrl_x_stops() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("c", "a", "space", "b")
        assert app.screen.query_one(CommandLine).query_one(Input).value == "a b"
        assert opener.graph.asked(Publish) == []
        await pilot.press("ctrl+x")
        assert opener.graph.asked(Publish) == [STOP]


@pytest.mark.parametrize("key", ["f1", "ctrl+p"])
async def test_a_dialog_does_not_come_before_the_stop(key: str) -> None:
    opener = RecordedOpener()
    async with opened(opener) as (_app, pilot):
        await pilot.press(key)
        await pilot.pause()
        await pilot.press("ctrl+x")
        assert opener.graph.asked(Publish) == [STOP]


async def test_where_nobody_listens_the_nodes_are_stopped_instead() -> None:
    deaf = tuple(row for row in TOPICS if row.name != EMERGENCY_STOP)
    opener = RecordedOpener(graph=RecordedGraph(lesson_update(topics=deaf)))
    async with opened(opener) as (app, pilot):
        await pilot.press("space")
        await pilot.pause()
        assert ("stop",) in opener.link.asked
        assert STOP in opener.graph.asked(Publish)
        assert "nobody listens" in app.screen.query_one(TitleBar).text
        assert ["nobody listens" in told.message for told in app._notifications] == [True]


async def test_the_release_starts_again_what_the_stop_has_ended_and_nothing_else() -> None:
    deaf = tuple(row for row in TOPICS if row.name != EMERGENCY_STOP)
    opener = RecordedOpener(graph=RecordedGraph(lesson_update(topics=deaf)))
    link = opener.link
    assert isinstance(link, RecordedSession)
    first, *others = link.nodes
    async with opened(opener) as (app, pilot):
        link.set_state(first, NodeState.EXITED)
        await settle(pilot)
        await pilot.press("space")
        await settle(pilot)
        assert "^r starts them again" in app.screen.query_one(TitleBar).text
        for name in others:
            link.set_state(name, NodeState.EXITED)
        # A second press has nothing to end, and forgets nothing.
        await pilot.press("space")
        await settle(pilot)
        assert not [asked for asked in link.asked if asked[0] == "start"], "not by itself"
        await pilot.press("ctrl+r")
        await settle(pilot)
        assert link.asked[-1] == ("start", *others)
        assert not app.emergency.state.engaged
        await pilot.press("ctrl+r")
        await settle(pilot)
        assert [asked[0] for asked in link.asked].count("start") == 1


async def test_a_release_is_repeated_with_its_time_to_a_node_that_has_not_heard(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    opener, now = RecordedOpener(), [NOW_S]
    monkeypatch.setattr("tui.clock.now", lambda: now[0])
    async with opened(opener) as (_app, pilot):
        for now[0] in (NOW_S, NOW_S + 1):
            opener.graph.show(obeyed(word(GATE, True, now[0], since_s=NOW_S), at_s=now[0]))
            await settle(pilot)
        await pilot.press("ctrl+r")
        for seconds in (2.5, 4, 9, 13, 15):
            now[0] = NOW_S + seconds
            opener.graph.show(obeyed(word(GATE, True, now[0], since_s=NOW_S), at_s=now[0]))
            await settle(pilot)
        assert opener.graph.asked(Publish) == [GO]
        link = opener.link
        assert isinstance(link, RecordedSession)
        assert link.stops == 4 * [False]
        assert len(set(link.said_ns)) == 1


async def test_where_ros_cannot_be_reached_the_nodes_are_stopped_instead() -> None:
    opener = RecordedOpener()
    opener.graph.publish_error = RuntimeError("no rclpy")
    async with opened(opener) as (app, pilot):
        await pilot.press("space")
        await pilot.pause()
        assert ("stop",) in opener.link.asked
        assert "ROS cannot be reached" in app.screen.query_one(TitleBar).text


@pytest.mark.parametrize("is_confirmed", [True, False])
async def test_where_only_the_observer_hangs_the_nodes_that_hold_are_not_ended(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, is_confirmed: bool
) -> None:
    """By the disk they have it, and another observer tells so; if none does, they are ended."""
    monkeypatch.setenv("DECK_STATE_DIR", str(tmp_path))
    monkeypatch.setattr(control, "CONFIRMED_WITHIN_S", 1.0)
    opener = RecordedOpener()
    opener.graph.publish_error = ObserverError("it hangs")
    async with opened(opener) as (app, pilot):
        opener.graph.show(obeyed(word(GATE, False, NOW_S), at_s=NOW_S))
        await settle(pilot)
        StopFile(opener.link.session.domain, "/screen").give(Stop(time.time_ns()), BY_SCREEN)
        await pilot.press("space")
        if is_confirmed:
            at_s = app.emergency.state.asked_s + 1.0
            opener.graph.show(obeyed(word(GATE, True, at_s, since_s=at_s), at_s=at_s))
        stopping = [worker for worker in app.workers if worker.group == "emergency"]
        await app.workers.wait_for_complete(stopping)
        assert (("stop",) in opener.link.asked) is not is_confirmed


async def test_a_stop_from_elsewhere_shows_here_and_can_be_released_here() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        opener.graph.show(said(True, NOW_S + 1))
        await settle(pilot)
        assert "by another" in app.screen.query_one(TitleBar).text
        await pilot.press("ctrl+r")
        assert opener.graph.asked(Publish)[-1] == GO


async def test_a_release_without_a_stop_publishes_nothing_and_says_so() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        assert "Release" not in str(app.screen.query_one(KeyBar).render())
        await pilot.press("ctrl+r")
        await pilot.pause()
        assert opener.graph.asked(Publish) == []
        assert [one.message for one in app._notifications] == [
            "Nothing is released: this screen knows of no emergency stop."
        ]


async def test_the_safety_nodes_words_stand_in_the_title() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        assert "0.38 m" not in app.screen.query_one(TitleBar).text
        opener.graph.show(held(b"\x01", "front 0.38 m"))
        await settle(pilot)
        assert "⚠ Front 0.38 m" in title.alarm(app)[1][0]
        assert "⚠ Front 0.38 m" in seen(app).splitlines()[1], "and is drawn, on a line of its own"


async def test_what_the_gate_refuses_stands_in_the_title_though_nothing_is_held() -> None:
    refused = "0.8 m/s, limit 0.5 m/s"
    values = [{"key": "verdict", "value": "free"}, {"key": "refused", "value": refused}]
    status = [{"level": b"\x01", "name": "safety_stop", "message": "-", "values": values}]
    one = sample(SAFETY_STATE, "diagnostic_msgs/msg/DiagnosticArray", {"status": status})
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        opener.graph.show(lesson_update(samples={SAFETY_STATE: (one,)}))
        await settle(pilot)
        assert f"⚠ Refused: {refused}" in app.screen.query_one(TitleBar).text


@pytest.mark.parametrize(
    ("language", "words"),
    [
        ("en", "⚠ Forward is blocked: mock_sonar speaks too rarely ahead"),
        ("ru", "⚠ Вперёд нельзя: mock_sonar: показания спереди слишком редки"),
    ],
)
async def test_who_speaks_too_rarely_is_named_whole_on_a_small_terminal(language: str, words: str) -> None:
    set_language(language)
    told = {"verdict": "blocked_forward", "front": "silent", "front_too_rare": "/mock_sonar"}
    values = [{"key": key, "value": value} for key, value in told.items()]
    status = [{"level": b"\x02", "name": "safety_stop", "message": "-", "values": values}]
    one = sample(SAFETY_STATE, "diagnostic_msgs/msg/DiagnosticArray", {"status": status})
    opener = RecordedOpener()
    async with opened(opener, size=(80, 24)) as (app, pilot):
        opener.graph.show(lesson_update(samples={SAFETY_STATE: (one,)}))
        await settle(pilot)
        assert words in app.screen.query_one(TitleBar).text


async def test_another_session_begins_without_the_stop_of_the_one_before() -> None:
    opener = RecordedOpener(sessions=[])
    async with opened(opener) as (app, pilot):
        await pilot.press("space", "f8")
        await pilot.pause()
        app.sessions.open(app.sessions.request)
        await settle(pilot)
        assert not app.emergency.state.engaged


async def test_the_stop_waits_neither_for_the_event_loop_nor_for_keys() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        assert app.is_stop("space")
        pressed = threading.Thread(target=app.stop_wheels)
        pressed.start()
        # The event loop does not run meanwhile.
        pressed.join(20)
        assert opener.graph.asked(Publish) == [STOP]
        assert not app.emergency.state.engaged
        await pilot.pause()
        assert "■ EMERGENCY STOP" in app.screen.query_one(TitleBar).text


async def test_a_space_is_a_letter_in_a_text_field_and_stops_nothing_without_a_session() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("c")
        assert isinstance(app.focused, Input)
        assert not app.is_stop("space")
        assert app.is_stop("ctrl+x")
        assert not app.is_stop("a")
        await pilot.press("escape")
        app.set_keymap({"emergency.stop": "f12"})
        assert app.is_stop("f12")
        assert not app.is_stop("space")
    async with opened(order=OpenRequest()) as (app, _pilot):
        assert not app.is_stop("ctrl+x")


async def test_a_release_that_was_typed_before_the_stop_does_not_release_it() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await pilot.press("space")
        release = Key("ctrl+r", None)
        await asyncio.to_thread(app.stop_wheels)
        app.stopped_s = time.monotonic()
        app.post_message(release)
        await pilot.pause()
        assert GO not in opener.graph.asked(Publish)
        assert app.emergency.state.engaged
        await pilot.press("ctrl+r")
        assert opener.graph.asked(Publish)[-1] == GO


async def test_without_its_terminal_it_commands_nothing_any_more() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, _pilot):
        await asyncio.to_thread(app.terminal_lost)
        assert opener.graph.asked(StopCommanding)


async def test_without_its_keys_it_stops_the_wheels_and_ends() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        await asyncio.to_thread(app.keyboard_lost, RuntimeError("no key"))
        await settle(pilot)
        assert opener.graph.asked(Publish) == [STOP]
        assert app.return_code == 1


async def test_a_publisher_that_fails_ends_neither_the_stop_nor_the_keys() -> None:
    opener = RecordedOpener()
    async with opened(opener) as (app, pilot):
        ask, refused = opener.graph.ask, ["the middleware is gone"]

        def at_second_try(request: Request[Any]) -> Future[Any]:
            if refused:
                raise RuntimeError(refused.pop())
            return ask(request)

        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(opener.graph, "ask", at_second_try)
            await asyncio.to_thread(app.stop_wheels)
            await pilot.pause()
        assert opener.graph.asked(Publish) == [STOP]
        assert app.emergency.state.engaged
