"""A dead-man's switch: what is held rests when its time is over, whatever was said before."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.publishing.dead_man_switch import LONGEST_S, RESTS, CommandRepeater, HeldCommand

GO, OTHER, REST = {"speed": 0.2}, {"speed": -0.2}, {"speed": 0.0}


class Wire:
    """What has been published."""

    def __init__(self) -> None:
        self.sent: list[Mapping[str, Any]] = []
        self.fails = False

    def __call__(self, value: Mapping[str, Any]) -> None:
        if self.fails:
            raise RuntimeError("the middleware is full")
        self.sent.append(value)


def command(until_s: float, value: Mapping[str, Any] = GO) -> HeldCommand:
    return HeldCommand(value, REST, 20.0, until_s)


def test_it_goes_out_at_once_at_its_rate_and_rests_on_time() -> None:
    wire = Wire()
    repeater = CommandRepeater(wire)
    repeater.hold(command(10.12), 10.0)
    assert wire.sent == [GO]
    assert repeater.step(10.01) == pytest.approx(10.05)
    assert repeater.step(10.06) == pytest.approx(10.10)
    assert repeater.step(10.11) == pytest.approx(10.12)
    repeater.step(10.12)
    assert wire.sent == [GO, GO, GO, REST]


def test_it_rests_a_few_times_and_then_is_silent() -> None:
    wire = Wire()
    repeater = CommandRepeater(wire)
    repeater.hold(command(10.1), 10.0)
    for n in range(100):
        repeater.step(20.0 + n)
    assert wire.sent == [GO, *[REST] * RESTS]
    assert repeater.step(200.0) is None


def test_another_value_goes_out_at_once_and_the_same_one_at_its_rate() -> None:
    wire = Wire()
    repeater = CommandRepeater(wire)
    repeater.hold(command(10.5), 10.0)
    repeater.hold(command(10.6), 10.01)
    repeater.hold(command(10.6, OTHER), 10.02)
    assert wire.sent == [GO, OTHER]


def test_a_word_that_comes_too_late_moves_nothing() -> None:
    wire = Wire()
    repeater = CommandRepeater(wire)
    repeater.hold(command(10.0), 10.0)
    assert wire.sent == []
    assert not repeater.is_held


def test_no_word_is_good_for_long() -> None:
    wire = Wire()
    repeater = CommandRepeater(wire)
    repeater.hold(command(1e9), 10.0)
    repeater.step(10.0 + LONGEST_S)
    assert wire.sent[-1] == REST


def test_letting_go_rests_at_once() -> None:
    wire = Wire()
    repeater = CommandRepeater(wire)
    repeater.let_go(10.0)
    assert wire.sent == []
    repeater.hold(command(11.0), 10.0)
    repeater.let_go(10.01)
    assert wire.sent == [GO, REST]


def test_what_cannot_be_published_is_held_no_more() -> None:
    wire = Wire()
    repeater = CommandRepeater(wire)
    wire.fails = True
    with pytest.raises(RuntimeError):
        repeater.hold(command(11.0), 10.0)
    assert not repeater.is_held
    wire.fails = False
    assert repeater.step(10.1) is None
    assert wire.sent == []


acts = st.lists(
    st.tuples(
        st.floats(0.0, 0.7), st.sampled_from(["hold", "other", "let go", "step"]), st.floats(-1, 3)
    ),
    max_size=40,
)


@given(acts)
def test_whatever_is_said_it_ends_at_rest(history: list[tuple[float, str, float]]) -> None:
    wire = Wire()
    repeater, now_s, good_until_s = CommandRepeater(wire), 100.0, 0.0
    for pause_s, what, good_for_s in history:
        now_s += pause_s
        before = len(wire.sent)
        if what in {"hold", "other"}:
            repeater.hold(command(now_s + good_for_s, GO if what == "hold" else OTHER), now_s)
            if now_s + good_for_s > now_s:
                good_until_s = now_s + good_for_s
        elif what == "let go":
            repeater.let_go(now_s)
            good_until_s = min(good_until_s, now_s)
        else:
            repeater.step(now_s)
        if now_s >= good_until_s:
            assert all(value == REST for value in wire.sent[before:])
    repeater.step(now_s + 3.0)
    assert not wire.sent or wire.sent[-1] == REST
    assert not repeater.is_held
