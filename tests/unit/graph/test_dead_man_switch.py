"""A dead-man's switch: what is held rests when its time is over, whatever was said before."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.publishing.dead_man_switch import LONGEST_S, RESTS, Grip, Holding

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


def word(until_s: float, value: Mapping[str, Any] = GO) -> Holding:
    return Holding(value, REST, 20.0, until_s)


def test_it_goes_out_at_once_at_its_rate_and_rests_on_time() -> None:
    wire = Wire()
    grip = Grip(wire)
    grip.hold(word(10.12), 10.0)
    assert wire.sent == [GO]
    assert grip.step(10.01) == pytest.approx(10.05)
    assert grip.step(10.06) == pytest.approx(10.10)
    assert grip.step(10.11) == pytest.approx(10.12)
    grip.step(10.12)
    assert wire.sent == [GO, GO, GO, REST]


def test_it_rests_a_few_times_and_then_is_silent() -> None:
    wire = Wire()
    grip = Grip(wire)
    grip.hold(word(10.1), 10.0)
    for n in range(100):
        grip.step(20.0 + n)
    assert wire.sent == [GO, *[REST] * RESTS]
    assert grip.step(200.0) is None


def test_another_value_goes_out_at_once_and_the_same_one_at_its_rate() -> None:
    wire = Wire()
    grip = Grip(wire)
    grip.hold(word(10.5), 10.0)
    grip.hold(word(10.6), 10.01)
    grip.hold(word(10.6, OTHER), 10.02)
    assert wire.sent == [GO, OTHER]


def test_a_word_that_comes_too_late_moves_nothing() -> None:
    wire = Wire()
    grip = Grip(wire)
    grip.hold(word(10.0), 10.0)
    assert wire.sent == []
    assert not grip.is_held


def test_no_word_is_good_for_long() -> None:
    wire = Wire()
    grip = Grip(wire)
    grip.hold(word(1e9), 10.0)
    grip.step(10.0 + LONGEST_S)
    assert wire.sent[-1] == REST


def test_letting_go_rests_at_once() -> None:
    wire = Wire()
    grip = Grip(wire)
    grip.let_go(10.0)
    assert wire.sent == []
    grip.hold(word(11.0), 10.0)
    grip.let_go(10.01)
    assert wire.sent == [GO, REST]


def test_what_cannot_be_published_is_held_no_more() -> None:
    wire = Wire()
    grip = Grip(wire)
    wire.fails = True
    with pytest.raises(RuntimeError):
        grip.hold(word(11.0), 10.0)
    assert not grip.is_held
    wire.fails = False
    assert grip.step(10.1) is None
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
    grip, now_s, good_until_s = Grip(wire), 100.0, 0.0
    for pause_s, what, good_for_s in history:
        now_s += pause_s
        before = len(wire.sent)
        if what in {"hold", "other"}:
            grip.hold(word(now_s + good_for_s, GO if what == "hold" else OTHER), now_s)
            if now_s + good_for_s > now_s:
                good_until_s = now_s + good_for_s
        elif what == "let go":
            grip.let_go(now_s)
            good_until_s = min(good_until_s, now_s)
        else:
            grip.step(now_s)
        if now_s >= good_until_s:
            assert all(value == REST for value in wire.sent[before:])
    grip.step(now_s + 3.0)
    assert not wire.sent or wire.sent[-1] == REST
    assert not grip.is_held
