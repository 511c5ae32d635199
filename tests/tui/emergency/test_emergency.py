"""The state of the emergency stop: known from whoever tells it, and not undone by old words."""

from __future__ import annotations

import os
import time
from typing import Any

import pytest

from graph.data import GraphUpdate, Sample
from safety.topics import EMERGENCY_STATE, EMERGENCY_STOP
from tests.tui.recorded import NOW_S, lesson_update
from tests.tui.recorded_emergency import CHASSIS, GATE, gate_says, held, obeyed, said, word
from tui.emergency.state import TOPIC_TYPE, Emergency
from tui.emergency.words import stop_words

NOTHING = Emergency()


def after(*steps: GraphUpdate, begin: Emergency = NOTHING) -> Emergency:
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


def test_a_stop_that_no_node_has_taken_stays_and_is_told() -> None:
    free = word(GATE, False, NOW_S - 1, since_s=NOW_S - 60)
    state = after(obeyed(free, at_s=NOW_S)).pressed(NOW_S)
    for seconds in (1.0, 2.5):
        free = word(GATE, False, NOW_S + seconds, since_s=NOW_S - 60)
        state = after(obeyed(free, at_s=NOW_S + seconds), begin=state)
        assert state.engaged
    assert stop_words(state, "^r")[0] == "■ EMERGENCY STOP · not obeyed by safety_stop · ^r releases"


def test_who_looks_later_sees_what_is_held_and_for_how_long() -> None:
    since_s = time.mktime((2026, 5, 4, 3, 2, 1, 0, 0, -1))
    held = word(GATE, True, NOW_S, since_s=since_s, by="topic", remembered="true")
    state = after(obeyed(held, at_s=NOW_S))
    assert state.engaged
    assert stop_words(state, "^r")[0] == ("■ EMERGENCY STOP (from earlier) since 2026-05-04 03:02 · ^r releases")


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
def test_it_is_said_who_has_given_it(more: dict[str, Any], words: str) -> None:
    free = word(CHASSIS, False, NOW_S, since_s=0.0)
    state = after(obeyed(free, at_s=NOW_S), obeyed(word(CHASSIS, True, NOW_S + 1, **more), at_s=NOW_S + 1))
    assert stop_words(state, "^r")[-2].startswith(f"■ EMERGENCY STOP {words} ·")


def test_where_nodes_differ_the_banner_says_so_when_they_have_had_the_time() -> None:
    state = Emergency().pressed(NOW_S)
    gate, chassis = word(GATE, True, NOW_S + 0.1), word(CHASSIS, True, NOW_S + 0.1)
    state = after(obeyed(gate, chassis, at_s=NOW_S + 0.2), said(False, NOW_S + 9), begin=state)
    for seconds in (9.2, 10.2, 11.2, 12.2):
        gate = word(GATE, False, NOW_S + seconds, since_s=NOW_S + 9)
        chassis = word(CHASSIS, True, NOW_S + seconds, since_s=NOW_S + 0.1)
        state = after(obeyed(gate, chassis, at_s=NOW_S + seconds), begin=state)
        differing = "held by chassis, released by safety_stop"
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
    old = Sample(EMERGENCY_STOP, TOPIC_TYPE, NOW_S, 0.0, 4, {"data": True}, sent_s=NOW_S - 60)
    free = word(GATE, False, NOW_S, since_s=NOW_S - 30)
    assert not after(obeyed(free, at_s=NOW_S, samples={EMERGENCY_STOP: (old,)})).engaged


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
    one = Sample(EMERGENCY_STATE, "diagnostic_msgs/msg/DiagnosticArray", NOW_S, 0.0, 9, {"status": status})
    assert not Emergency().seen(lesson_update(samples={EMERGENCY_STATE: (one,)})).nodes


def test_what_others_said_before_our_own_word_does_not_undo_it() -> None:
    pressed = Emergency().pressed(NOW_S)
    assert pressed.seen(said(False, NOW_S - 0.1)).engaged
    assert not pressed.seen(said(False, NOW_S + 0.1)).engaged


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
def test_what_the_gate_said_before_it_heard_of_a_release_does_not_stop_anew(by_another: bool) -> None:
    state = Emergency().seen(gate_says("emergency_stop", NOW_S))
    state = state.seen(said(False, NOW_S + 1)) if by_another else state.released(NOW_S + 1)
    assert not state.engaged
    for seconds in (0.9, 1.1, 2.0):
        state = state.seen(gate_says("emergency_stop", NOW_S + seconds))
        assert not state.engaged
    assert state.seen(gate_says("emergency_stop", NOW_S + 4)).engaged


def test_what_a_stop_has_ended_is_forgotten_with_it() -> None:
    state = NOTHING.pressed(NOW_S).fallen_back("why", ("hello",)).pressed(NOW_S + 1)
    assert state.ended == ("hello",)
    assert not state.seen(said(False, NOW_S + 2)).ended
    assert not state.released(NOW_S + 2).ended


def test_a_stop_pressed_while_the_link_is_down_is_not_told_as_obeyed() -> None:
    """A cut of 45 s: the nodes are silent, then out of the graph, then back, and obey."""
    free = word(GATE, False, NOW_S, since_s=NOW_S - 60)
    state = after(obeyed(free, at_s=NOW_S)).pressed(NOW_S + 5)
    unsure = "■ EMERGENCY STOP · pressed, nobody has confirmed it · ^r releases"
    for seconds in (5.1, 8.0, 20.0):
        state = after(obeyed(at_s=NOW_S + seconds), begin=state)
        assert stop_words(state, "^r")[0] == unsure
    state = after(lesson_update(samples={}, nodes=(), time_s=NOW_S + 40), begin=state)
    assert stop_words(state, "^r")[0] == unsure
    state = after(obeyed(word(GATE, True, NOW_S + 46), at_s=NOW_S + 46), begin=state)
    assert "confirmed" not in stop_words(state, "^r")[0]


def test_a_stop_of_another_screen_is_not_told_as_obeyed_before_a_node_says_so() -> None:
    """Two screens beyond a cut: the one hears the stop that the other gives."""
    free = word(GATE, False, NOW_S, since_s=NOW_S - 60)
    state = after(obeyed(free, at_s=NOW_S), said(True, NOW_S + 5))
    unsure = "■ EMERGENCY STOP (by another) · pressed, nobody has confirmed it · ^r releases"
    assert stop_words(state, "^r")[0] == unsure
    state = after(lesson_update(samples={}, nodes=(), time_s=NOW_S + 40), begin=state)
    state = after(said(True, NOW_S + 41), begin=state)
    assert stop_words(state, "^r")[0] == unsure
    state = after(obeyed(word(GATE, True, NOW_S + 46), at_s=NOW_S + 46), begin=state)
    assert not state.unconfirmed
    assert not after(said(True, NOW_S + 47), begin=state).unconfirmed, "the same stop, repeated"


def test_a_node_that_confirms_it_does_not_start_again_what_was_stopped_instead() -> None:
    state = NOTHING.pressed(NOW_S).fallen_back("all nodes are being stopped", ("hello",))
    assert not state.unconfirmed
    state = after(obeyed(word(GATE, True, NOW_S + 1), at_s=NOW_S + 1), begin=state)
    assert "all nodes are being stopped" in stop_words(state, "^r")[0]


def test_what_a_node_held_before_the_press_does_not_confirm_it() -> None:
    holding = word(GATE, True, NOW_S, since_s=NOW_S - 60)
    state = after(obeyed(holding, at_s=NOW_S)).pressed(NOW_S + 1)
    assert state.unconfirmed
    again = word(GATE, True, NOW_S + 1.2, since_s=NOW_S - 60)
    assert not after(obeyed(again, at_s=NOW_S + 1.3), begin=state).unconfirmed


def test_a_gate_that_obeys_confirms_it_where_no_node_reports() -> None:
    state = Emergency().pressed(NOW_S)
    assert state.unconfirmed
    assert not after(gate_says("emergency_stop", NOW_S + 0.1), begin=state).unconfirmed


def test_nodes_that_have_said_nothing_since_are_named() -> None:
    both = (word(GATE, False, NOW_S), word(CHASSIS, False, NOW_S))
    state = after(obeyed(*both, at_s=NOW_S)).pressed(NOW_S + 1)
    state = after(obeyed(word(GATE, True, NOW_S + 3), at_s=NOW_S + 4), begin=state)
    assert not state.unconfirmed
    assert "not confirmed by chassis" in stop_words(state, "^r")[0]
