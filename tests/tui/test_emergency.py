"""The emergency stop: at once, shown until released, and never without effect."""

from __future__ import annotations

import pytest
from textual.color import Color
from textual.widgets import Input

from graph.data import GraphUpdate, Sample
from tests.tui.app_runs import opened
from tests.tui.recorded import NOW_S, TOPICS, RecordedGraph, RecordedPad, lesson_update, sample
from tests.tui.snapshots import settle
from tui import title
from tui.emergency import SAFETY_TOPIC, TOPIC, TOPIC_TYPE, Emergency, listeners
from tui.widgets.command_line import CommandLine
from tui.widgets.key_bar import KeyBar
from tui.widgets.title_bar import TitleBar

STOP = (TOPIC, TOPIC_TYPE, {"data": True}, True)
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
        assert "⚠ Motion is held: front 0.38 m" in title.states(app)[0]


@pytest.mark.parametrize(
    ("refused", "words"),
    [
        ("0.8 m/s, limit 0.5 m/s", "⚠ refused: 0.8 m/s, limit 0.5 m/s"),
        ("stamp 10.0 s old", "⚠ refused: stamp 10.0 s old"),
        ("some\x1b[31mthing", "⚠ refused: some␛[31mthing"),
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
