"""The emergency stop: at once, shown until released, and never without effect."""

from __future__ import annotations

import os
import time
from typing import Any

import pytest
from textual.color import Color
from textual.widgets import Input

from graph.data import GraphUpdate, NodeRow, Sample
from launcher.status import NodeState
from tests.tui.app_runs import opened
from tests.tui.recorded import (
    NOW_S,
    TOPICS,
    RecordedGraph,
    RecordedPad,
    RecordedSession,
    lesson_update,
    sample,
)
from tests.tui.snapshots import settle
from tui import title
from tui.emergency import SAFETY_TOPIC, TOPIC, TOPIC_TYPE, Emergency, listeners
from tui.emergency_nodes import STATE_TOPIC
from tui.emergency_words import stop_words
from tui.widgets.command_line import CommandLine
from tui.widgets.key_bar import KeyBar
from tui.widgets.title_bar import TitleBar

STOP = (TOPIC, TOPIC_TYPE, {"data": True}, True)
GATE, CHASSIS = "/safety_stop", "/chassis"
STATES = "diagnostic_msgs/msg/DiagnosticArray"
NOTHING = Emergency()
GO = (TOPIC, TOPIC_TYPE, {"data": False}, True)


def said(engaged: bool, at_s: float) -> GraphUpdate:
    """The graph with one message on the topic of the stop."""
    one = Sample(TOPIC, TOPIC_TYPE, at_s, 0.0, 4, {"data": engaged})
    return lesson_update(samples={TOPIC: (one,)})


def held(level: bytes, words: str) -> GraphUpdate:
    """The graph with one word of the safety node."""
    status = [{"level": level, "name": "safety_stop", "message": words, "values": []}]
    one = sample(SAFETY_TOPIC, "diagnostic_msgs/msg/DiagnosticArray", {"status": status})
    return lesson_update(samples={SAFETY_TOPIC: (one,)})


def gate_says(verdict: str, at_s: float) -> GraphUpdate:
    """The graph with one verdict of the gate, as the safety node words it."""
    values = [{"key": "verdict", "value": verdict}]
    status = [{"level": b"\x02", "name": "safety_stop", "message": "held", "values": values}]
    kind = "diagnostic_msgs/msg/DiagnosticArray"
    one = Sample(SAFETY_TOPIC, kind, at_s, 0.0, 120, {"status": status})
    return lesson_update(samples={SAFETY_TOPIC: (one,)})


def word(
    node: str, engaged: bool, at_s: float, *, since_s: float | None = None, **more: str
) -> Sample:
    """What one node says of the stop that it obeys."""
    values = {"engaged": str(engaged).lower(), **more}
    values["since"] = str(at_s if since_s is None else since_s)
    pairs = [{"key": key, "value": value} for key, value in values.items()]
    status = [{"level": b"\x02" if engaged else b"\x00", "name": node, "values": pairs}]
    return Sample(
        STATE_TOPIC, "diagnostic_msgs/msg/DiagnosticArray", at_s, 0.0, 120, {"status": status}
    )


def obeyed(*words: Sample, at_s: float, **more: Any) -> GraphUpdate:
    """The graph with what nodes say."""
    nodes = (NodeRow(GATE), NodeRow(CHASSIS))
    samples = {STATE_TOPIC: words, **more.pop("samples", {})}
    return lesson_update(samples=samples, nodes=nodes, time_s=at_s, **more)


def after(*steps: GraphUpdate, begin: Emergency = NOTHING) -> Emergency:
    """How things stand when all this was seen."""
    for step in steps:
        begin = begin.seen(step)
    return begin


def test_a_release_that_only_the_nodes_have_heard_ends_the_banner() -> None:
    """`ros2 topic pub --once` leaves at once, and may never be heard here."""
    state = Emergency().pressed(NOW_S)
    both = (word(GATE, True, NOW_S + 0.1), word(CHASSIS, True, NOW_S + 0.1))
    state = after(obeyed(*both, at_s=NOW_S + 0.2), begin=state)
    assert state.engaged
    state = after(obeyed(word(GATE, False, NOW_S + 5), at_s=NOW_S + 5), begin=state)
    assert state.engaged, "one of them holds"
    state = after(obeyed(word(CHASSIS, False, NOW_S + 5), at_s=NOW_S + 5), begin=state)
    assert not state.engaged
    assert not state.ours
    again = obeyed(word(GATE, False, NOW_S + 6, since_s=NOW_S + 5), at_s=NOW_S + 6)
    assert not after(again, begin=state).engaged


def test_a_release_within_one_look_ends_it_too() -> None:
    state = Emergency().pressed(NOW_S)
    state = after(
        obeyed(word(GATE, False, NOW_S + 0.2, since_s=NOW_S + 0.1), at_s=NOW_S + 0.2), begin=state
    )
    assert not state.engaged


def test_a_stop_that_no_node_has_taken_stays_and_is_told() -> None:
    free = word(GATE, False, NOW_S - 1, since_s=NOW_S - 60)
    state = after(obeyed(free, at_s=NOW_S)).pressed(NOW_S)
    for seconds in (1.0, 2.5):
        free = word(GATE, False, NOW_S + seconds, since_s=NOW_S - 60)
        state = after(obeyed(free, at_s=NOW_S + seconds), begin=state)
        assert state.engaged
    assert (
        stop_words(state, "^r")[0] == "■ EMERGENCY STOP · not obeyed by safety_stop · ^r releases"
    )


def test_who_looks_later_sees_what_is_held_and_for_how_long() -> None:
    since_s = time.mktime((2026, 5, 4, 3, 2, 1, 0, 0, -1))
    held = word(GATE, True, NOW_S, since_s=since_s, by="topic", remembered="true")
    state = after(obeyed(held, at_s=NOW_S))
    assert state.engaged
    assert stop_words(state, "^r")[0] == (
        "■ EMERGENCY STOP (from before) since 2026-05-04 03:02 · ^r releases"
    )


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"by": "topic", "publishers": "/joy"}, "(by joy)"),
        ({"by": "topic", "publishers": f"/joy /_deck_observer_{os.getpid()}"}, "(by joy)"),
        ({"by": "topic", "publishers": "/joy /_deck_observer_1"}, "(by another)"),
        ({"by": "topic", "publishers": "/_deck_observer_1"}, "(by another)"),
        ({"by": "topic", "publishers": ""}, "(by another)"),
        ({"by": "pico"}, "(kept by the Pico)"),
        ({"by": "topic", "publishers": "/a\x1b[2J"}, "(by a␛[2J)"),
    ],
)
def test_it_is_said_who_has_given_it(more: dict[str, str], words: str) -> None:
    free = word(CHASSIS, False, NOW_S, since_s=0.0)
    state = after(
        obeyed(free, at_s=NOW_S), obeyed(word(CHASSIS, True, NOW_S + 1, **more), at_s=NOW_S + 1)
    )
    assert stop_words(state, "^r")[-2].startswith(f"■ EMERGENCY STOP {words} ·")


def test_where_nodes_differ_the_banner_says_so_when_they_have_had_the_time() -> None:
    state = Emergency().pressed(NOW_S)
    gate, chassis = word(GATE, True, NOW_S + 0.1), word(CHASSIS, True, NOW_S + 0.1)
    state = after(obeyed(gate, chassis, at_s=NOW_S + 0.2), said(False, NOW_S + 9), begin=state)
    for seconds in (9.2, 10.2, 11.2, 12.2):
        gate = word(GATE, False, NOW_S + seconds, since_s=NOW_S + 9)
        chassis = word(CHASSIS, True, NOW_S + seconds, since_s=NOW_S + 0.1)
        state = after(obeyed(gate, chassis, at_s=NOW_S + seconds), begin=state)
        differing = "held by chassis, released in safety_stop"
        assert (differing in stop_words(state, "^r")[0]) == (seconds > 12)


def test_our_release_is_awaited_of_each_node_and_told_of_who_is_late() -> None:
    state = Emergency().pressed(NOW_S)
    both = (word(GATE, True, NOW_S + 0.1), word(CHASSIS, True, NOW_S + 0.1))
    state = after(obeyed(*both, at_s=NOW_S + 0.2), begin=state).released(NOW_S + 5)
    assert state.engaged, "until they say so"
    for seconds in (5.2, 8.0):
        gate = word(GATE, False, NOW_S + seconds, since_s=NOW_S + 5.1)
        chassis = word(CHASSIS, True, NOW_S + seconds, since_s=NOW_S + 0.1)
        state = after(obeyed(gate, chassis, at_s=NOW_S + seconds), begin=state)
    assert set(state.awaited) == {CHASSIS}
    assert "released here, still held by chassis" in stop_words(state, "^r")[0]
    free = word(CHASSIS, False, NOW_S + 9)
    state = after(obeyed(free, at_s=NOW_S + 9), begin=state)
    assert not state.engaged
    assert state.ours


def test_a_new_stop_of_another_is_not_released_by_what_is_said_again() -> None:
    state = Emergency().pressed(NOW_S)
    state = after(obeyed(word(GATE, True, NOW_S + 0.1), at_s=NOW_S + 0.2), begin=state)
    state = state.released(NOW_S + 5)
    anew = obeyed(word(GATE, True, NOW_S + 6, since_s=NOW_S + 5.5), at_s=NOW_S + 6)
    state = after(anew, begin=state)
    assert not state.awaited
    assert state.engaged


def test_the_stop_stays_while_all_that_hold_it_are_away() -> None:
    held = obeyed(word(GATE, True, NOW_S), at_s=NOW_S)
    away = lesson_update(samples={}, nodes=(), time_s=NOW_S + 5)
    state = after(held, away)
    assert state.engaged
    assert not state.nodes
    back = word(GATE, True, NOW_S + 9, remembered="true")
    assert after(obeyed(back, at_s=NOW_S + 9), begin=state).engaged
    free = word(GATE, False, NOW_S + 9, since_s=0.0)
    assert not after(obeyed(free, at_s=NOW_S + 9), begin=state).engaged
    assert not state.released(NOW_S + 6).engaged, "there is nobody who could confirm it"


def test_an_old_latched_stop_that_the_nodes_have_released_since_is_none() -> None:
    old = Sample(TOPIC, TOPIC_TYPE, NOW_S, 0.0, 4, {"data": True}, sent_s=NOW_S - 60)
    free = word(GATE, False, NOW_S, since_s=NOW_S - 30)
    assert not after(obeyed(free, at_s=NOW_S, samples={TOPIC: (old,)})).engaged


@pytest.mark.parametrize(
    "status",
    [
        None,
        [3],
        [{"name": "/x", "values": 3}],
        [{"name": "/x", "values": [{"key": "engaged", "value": "perhaps"}]}],
        [{"name": "", "values": [{"key": "engaged", "value": "true"}]}],
    ],
)
def test_words_of_a_node_that_make_no_sense_are_none(status: Any) -> None:
    one = Sample(
        STATE_TOPIC, "diagnostic_msgs/msg/DiagnosticArray", NOW_S, 0.0, 9, {"status": status}
    )
    assert not Emergency().seen(lesson_update(samples={STATE_TOPIC: (one,)})).nodes


@pytest.mark.parametrize("since", ["nan", "inf", "-1e300", "1e300", "x", ""])
def test_a_time_that_makes_no_sense_is_not_told(since: str) -> None:
    pairs = [{"key": "engaged", "value": "true"}, {"key": "since", "value": since}]
    held = Sample(STATE_TOPIC, STATES, NOW_S, 0.0, 9, {"status": [{"name": GATE, "values": pairs}]})
    state = Emergency().seen(lesson_update(samples={STATE_TOPIC: (held,)}))
    assert stop_words(state, "^r")[0] == "■ EMERGENCY STOP (from before) · ^r releases"


def test_what_others_said_before_our_own_word_does_not_undo_it() -> None:
    pressed = Emergency().pressed(NOW_S)
    assert pressed.seen(said(False, NOW_S - 0.1)).engaged
    assert not pressed.seen(said(False, NOW_S + 0.1)).engaged


def test_a_stop_by_somebody_else_is_told_apart() -> None:
    state = Emergency().seen(said(True, NOW_S))
    assert state.engaged
    assert not state.ours


@pytest.mark.parametrize("level", [b"\x02", 2])
def test_the_gravest_word_of_the_safety_node_is_kept(level: bytes) -> None:
    state = Emergency().seen(held(level, "front 0.38 m"))
    assert state.blocked == "front 0.38 m"
    assert state.seen(held(b"\x00", "free")).blocked == ""


def test_a_stop_whose_publisher_has_gone_is_known_from_the_gate_until_it_says_otherwise() -> None:
    state = Emergency().seen(gate_says("emergency_stop", NOW_S))
    assert state.engaged
    assert not state.seen(gate_says("starting", NOW_S + 1)).engaged


def test_the_gates_word_does_not_undo_a_stop_that_was_said_here() -> None:
    state = Emergency().seen(gate_says("emergency_stop", NOW_S)).pressed(NOW_S + 1)
    assert state.seen(gate_says("free", NOW_S + 9)).engaged


@pytest.mark.parametrize("by_another", [False, True])
def test_what_the_gate_said_before_it_heard_of_a_release_does_not_stop_anew(
    by_another: bool,
) -> None:
    state = Emergency().seen(gate_says("emergency_stop", NOW_S))
    state = state.seen(said(False, NOW_S + 1)) if by_another else state.released(NOW_S + 1)
    assert not state.engaged
    for seconds in (0.9, 1.1, 2.0):
        state = state.seen(gate_says("emergency_stop", NOW_S + seconds))
        assert not state.engaged
    assert state.seen(gate_says("emergency_stop", NOW_S + 4)).engaged


def test_a_stop_by_somebody_else_is_told_apart_also_where_the_gate_tells_of_it_first() -> None:
    state = Emergency().seen(gate_says("emergency_stop", NOW_S)).seen(said(True, NOW_S + 0.1))
    assert state.engaged
    assert not state.ours
    assert state.seen(gate_says("free", NOW_S + 9)).engaged


def test_what_a_stop_has_ended_is_forgotten_with_it() -> None:
    state = NOTHING.pressed(NOW_S).fallen_back("why", ("hello",)).pressed(NOW_S + 1)
    assert state.ended == ("hello",)
    assert not state.seen(said(False, NOW_S + 2)).ended
    assert not state.released(NOW_S + 2).ended


def test_listeners_are_those_that_the_graph_knows() -> None:
    assert listeners(None) == 0
    assert listeners(lesson_update(topics=())) == 0
    assert listeners(lesson_update()) == 2


@pytest.mark.parametrize("screen", ["deck", "topics", "logs"])
async def test_space_stops_at_once_on_every_screen(screen: str) -> None:
    pad = RecordedPad()
    async with opened(pad, screen) as (app, pilot):
        await pilot.press("space")
        assert pad.graph.published == [STOP]
        title = app.screen.query_one(TitleBar)
        assert "■ EMERGENCY STOP · ^r releases" in title.text
        assert title.styles.background == Color.parse("#b00020")


async def test_the_publisher_is_made_before_it_is_needed() -> None:
    pad = RecordedPad()
    async with opened(pad):
        assert pad.graph.prepared == [(TOPIC, TOPIC_TYPE, True)]


async def test_the_stop_stays_until_it_is_released() -> None:
    pad = RecordedPad()
    async with opened(pad) as (app, pilot):
        await pilot.press("space", "space", "escape", "2", "1")
        assert app.brake.state.engaged
        assert GO not in pad.graph.published
        await pilot.press("ctrl+r")
        assert pad.graph.published[-1] == GO
        await pilot.pause()
        assert "EMERGENCY" not in app.screen.query_one(TitleBar).text


async def test_the_release_key_does_nothing_while_nothing_is_stopped() -> None:
    pad = RecordedPad()
    async with opened(pad) as (_app, pilot):
        await pilot.press("ctrl+r")
        assert pad.graph.published == []


async def test_in_a_text_field_space_is_a_blank_and_ctrl_x_stops() -> None:
    pad = RecordedPad()
    async with opened(pad) as (app, pilot):
        await pilot.press("c", "a", "space", "b")
        assert app.screen.query_one(CommandLine).query_one(Input).value == "a b"
        assert pad.graph.published == []
        await pilot.press("ctrl+x")
        assert pad.graph.published == [STOP]


@pytest.mark.parametrize("key", ["f1", "ctrl+p"])
async def test_a_dialog_does_not_come_before_the_stop(key: str) -> None:
    pad = RecordedPad()
    async with opened(pad) as (_app, pilot):
        await pilot.press(key)
        await pilot.pause()
        await pilot.press("ctrl+x")
        assert pad.graph.published == [STOP]


async def test_where_nobody_listens_the_nodes_are_stopped_instead() -> None:
    deaf = tuple(row for row in TOPICS if row.name != TOPIC)
    pad = RecordedPad(graph=RecordedGraph(lesson_update(topics=deaf)))
    async with opened(pad) as (app, pilot):
        await pilot.press("space")
        await pilot.pause()
        assert ("stop",) in pad.link.asked
        assert STOP in pad.graph.published
        assert "nobody listens" in app.screen.query_one(TitleBar).text
        assert ["nobody listens" in told.message for told in app._notifications] == [True]


async def test_the_release_starts_again_what_the_stop_has_ended_and_nothing_else() -> None:
    deaf = tuple(row for row in TOPICS if row.name != TOPIC)
    pad = RecordedPad(graph=RecordedGraph(lesson_update(topics=deaf)))
    link = pad.link
    assert isinstance(link, RecordedSession)
    first, *others = link.nodes
    async with opened(pad) as (app, pilot):
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
        assert not app.brake.state.engaged
        await pilot.press("ctrl+r")
        await settle(pilot)
        assert [asked[0] for asked in link.asked].count("start") == 1


async def test_the_release_is_said_again_to_a_node_that_has_not_heard(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pad, now = RecordedPad(), [NOW_S]
    monkeypatch.setattr("tui.clock.now", lambda: now[0])
    async with opened(pad) as (_app, pilot):
        for now[0] in (NOW_S, NOW_S + 1):
            pad.graph.show(obeyed(word(GATE, True, now[0], since_s=NOW_S), at_s=now[0]))
            await settle(pilot)
        await pilot.press("ctrl+r")
        for seconds in (2.5, 4, 9, 13, 15):
            now[0] = NOW_S + seconds
            pad.graph.show(obeyed(word(GATE, True, now[0], since_s=NOW_S), at_s=now[0]))
            await settle(pilot)
        assert pad.graph.published == 4 * [GO]


async def test_the_release_of_another_is_told() -> None:
    pad = RecordedPad()
    async with opened(pad) as (app, pilot):
        pad.graph.show(obeyed(word(GATE, True, NOW_S), at_s=NOW_S))
        await settle(pilot)
        assert "EMERGENCY STOP" in app.screen.query_one(TitleBar).text
        pad.graph.show(obeyed(word(GATE, False, NOW_S + 5), at_s=NOW_S + 5))
        await settle(pilot)
        assert "EMERGENCY STOP" not in app.screen.query_one(TitleBar).text
        assert ["Another has released" in told.message for told in app._notifications] == [True]


async def test_where_ros_cannot_be_reached_the_nodes_are_stopped_instead() -> None:
    pad = RecordedPad()
    pad.graph.publish_error = RuntimeError("no rclpy")
    async with opened(pad) as (app, pilot):
        await pilot.press("space")
        await pilot.pause()
        assert ("stop",) in pad.link.asked
        assert "ROS cannot be reached" in app.screen.query_one(TitleBar).text


async def test_a_stop_from_elsewhere_shows_here_and_can_be_released_here() -> None:
    pad = RecordedPad()
    async with opened(pad) as (app, pilot):
        pad.graph.show(said(True, NOW_S + 1))
        await pilot.pause()
        await pilot.pause()
        assert "by another" in app.screen.query_one(TitleBar).text
        await pilot.press("ctrl+r")
        assert pad.graph.published == [GO]


async def test_a_stop_whose_publisher_has_gone_can_be_released() -> None:
    pad = RecordedPad()
    async with opened(pad) as (app, pilot):
        pad.graph.show(gate_says("emergency_stop", NOW_S))
        await settle(pilot)
        assert "■ EMERGENCY STOP · ^r releases" in app.screen.query_one(TitleBar).text
        assert "^r Release" in str(app.screen.query_one(KeyBar).render())
        await pilot.press("ctrl+r")
        assert pad.graph.published == [GO]


async def test_the_safety_nodes_words_stand_in_the_title() -> None:
    pad = RecordedPad()
    async with opened(pad) as (app, pilot):
        pad.graph.show(held(b"\x01", "front 0.38 m"))
        await pilot.pause()
        await pilot.pause()
        assert "⚠ Front 0.38 m" in title.states(app)[0]


async def test_long_words_of_the_safety_node_leave_the_tabs_their_names() -> None:
    pad = RecordedPad()
    async with opened(pad, size=(80, 24)) as (app, pilot):
        pad.graph.show(held(b"\x01", "front 0.38 m, and the left wheel has told nothing for 2 s"))
        await settle(pilot)
        line = app.screen.query_one(TitleBar).text
        for name in ("1 Deck", "2 Top.", "3 Com.", "4 Logs", "5 Gra.", "6 Flow", "7 Dev."):
            assert name in line
        assert "⚠ Front 0.38 m" in line
        assert line.rstrip().endswith("…")


@pytest.mark.parametrize(
    ("refused", "words"),
    [
        ("0.8 m/s, limit 0.5 m/s", "⚠ Refused: 0.8 m/s, limit 0.5 m/s"),
        ("stamp 10.0 s old", "⚠ Refused: stamp 10.0 s old"),
        ("some\x1b[31mthing", "⚠ Refused: some␛[31mthing"),
    ],
)
async def test_what_the_gate_refuses_stands_in_the_title_though_nothing_is_held(
    refused: str, words: str
) -> None:
    values = [{"key": "verdict", "value": "free"}, {"key": "refused", "value": refused}]
    status = [{"level": b"\x01", "name": "safety_stop", "message": "-", "values": values}]
    one = sample(SAFETY_TOPIC, "diagnostic_msgs/msg/DiagnosticArray", {"status": status})
    pad = RecordedPad()
    async with opened(pad) as (app, pilot):
        pad.graph.show(lesson_update(samples={SAFETY_TOPIC: (one,)}))
        await settle(pilot)
        assert words in app.screen.query_one(TitleBar).text


async def test_another_session_begins_without_the_stop_of_the_one_before() -> None:
    pad = RecordedPad(sessions=[])
    async with opened(pad) as (app, pilot):
        await pilot.press("space", "f8")
        await pilot.pause()
        app.sessions.open(app.sessions.order)
        await pilot.pause()
        await pilot.pause()
        assert not app.brake.state.engaged
