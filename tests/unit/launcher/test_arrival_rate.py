"""The rate that a topic is ready by."""

from __future__ import annotations

import pytest

from launcher.spawn_server.arrival_rate import COUNTED, ArrivalRate

NOW_S = 1_800_000_000.0


def rate(sent: list[float], received: list[float], later_s: float = 0.0) -> float:
    """The rate so long after the last message."""
    counted = ArrivalRate()
    for sent_s, received_s in zip(sent, received, strict=True):
        counted.add(sent_s, NOW_S + received_s)
    return counted.hz(NOW_S + received[-1] + later_s)


def steady(period_s: float, begin_s: float = NOW_S) -> list[float]:
    return [begin_s + number * period_s for number in range(COUNTED)]


def test_it_is_that_of_the_last_messages() -> None:
    assert rate(steady(0.02), steady(0.02, 0.0)) == pytest.approx(50)
    assert rate([0.0] * COUNTED, steady(0.02, 0.0)) == pytest.approx(50)
    assert rate(steady(0.02)[1:], steady(0.02, 0.0)[1:]) == 0


def test_messages_that_were_held_up_and_arrive_together_are_no_higher_rate() -> None:
    # The publisher's clock may be another one.
    assert rate(steady(0.02, 7.0), steady(0.001, 0.0)) == pytest.approx(50, rel=0.01)


def test_whoever_falls_silent_does_not_keep_the_rate() -> None:
    assert rate(steady(0.02), steady(0.02, 0.0), later_s=4.0) < 1.1
