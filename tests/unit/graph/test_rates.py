"""Rates from a few looks a second: exact between stamps, whatever the looks, restarts or clocks."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.observer.rates import RateMeter
from graph.observer.timing import Arrival

T0 = 1_700_000_000.0


def looked_at(
    stamps: list[float], looks: list[float], *, depth: int = 1000, numbered: bool = True
) -> RateMeter:
    """Return a meter after looks at a queue that keeps the last `depth` messages."""
    meter, waiting = RateMeter(), list(enumerate(stamps))
    for look in looks:
        come = [(n, stamp) for n, stamp in waiting if stamp <= look]
        waiting = waiting[len(come) :]
        batch = [Arrival(T0 + s, 8, n if numbered else None) for n, s in come[-depth:]]
        meter.add(batch, overflowed=len(come) >= depth)
    return meter


def every(period_s: float, until_s: float, phase_s: float = 0.0) -> list[float]:
    return [phase_s + n * period_s for n in range(int((until_s - phase_s) / period_s) + 1)]


@given(
    hz=st.floats(0.5, 500),
    look_s=st.floats(0.05, 0.5),
    phase_s=st.floats(0, 0.05),
)
def test_a_steady_rate_is_exact_however_it_is_looked_at(
    hz: float, look_s: float, phase_s: float
) -> None:
    meter = looked_at(every(1 / hz, 10, phase_s), every(look_s, 10))
    assert meter.hz(T0 + 10) == pytest.approx(hz, rel=0.001)


@given(hz=st.floats(20, 200), look_s=st.floats(0.2, 0.5), depth=st.integers(3, 5))
def test_a_rate_is_right_though_the_queue_keeps_only_the_newest(
    hz: float, look_s: float, depth: int
) -> None:
    meter = looked_at(every(1 / hz, 10), every(look_s, 10), depth=depth)
    assert meter.hz(T0 + 10) == pytest.approx(hz, rel=0.001)
    assert meter.bytes_per_s(T0 + 10) == pytest.approx(8 * hz, rel=0.001)


def test_without_numbers_only_what_came_is_counted() -> None:
    meter = looked_at(every(0.01, 5), every(0.1, 5), depth=5, numbered=False)
    assert meter.hz(T0 + 5) == pytest.approx(50, rel=0.05)


def test_messages_lost_on_the_way_are_not_counted() -> None:
    """Every second one is lost, and the queue was never full: that was not our doing."""
    meter = RateMeter()
    for look in range(40):
        numbers = range(10 * look, 10 * look + 10, 2)
        meter.add([Arrival(T0 + n / 100, 8, n) for n in numbers], overflowed=False)
    assert meter.count == 200
    assert meter.hz(T0 + 4) == pytest.approx(50, rel=0.01)


def test_a_publisher_that_starts_anew_counts_from_one_again() -> None:
    meter = RateMeter()
    meter.add([Arrival(T0, 8, 5000)], overflowed=True)
    meter.add([Arrival(T0 + 0.1, 8, 1), Arrival(T0 + 0.2, 8, 2)], overflowed=True)
    assert meter.count == 3


def test_one_message_has_an_age_and_no_rate() -> None:
    meter = RateMeter()
    assert (meter.hz(T0), meter.age_s(T0), meter.count) == (None, None, 0)
    meter.add([Arrival(T0, 100)])
    assert meter.hz(T0 + 1) is None
    assert meter.bytes_per_s(T0 + 1) is None
    assert meter.age_s(T0 + 1) == 1.0
    assert not meter.is_quiet(T0 + 3)
    assert meter.is_quiet(T0 + 3.1)


def test_what_has_gone_quiet_has_the_rate_zero_and_recovers_at_once() -> None:
    stamps = every(0.1, 4)
    meter = looked_at(stamps, every(0.1, 4))
    assert meter.hz(T0 + 5) == pytest.approx(10)
    assert meter.hz(T0 + 7.5) == 0.0
    assert meter.bytes_per_s(T0 + 7.5) == 0.0
    for n in range(10):
        meter.add([Arrival(T0 + 60 + n / 20, 8)])
    assert meter.hz(T0 + 60.5) == pytest.approx(20)


def test_a_slow_topic_has_a_rate_and_is_not_quiet_between_two_messages() -> None:
    meter = looked_at(every(10, 60), every(0.25, 60))
    assert meter.hz(T0 + 65) == pytest.approx(0.1)
    assert not meter.is_quiet(T0 + 75)
    assert meter.is_quiet(T0 + 91)


def test_a_change_of_rate_shows_within_the_window() -> None:
    stamps = every(0.1, 10) + [10 + t for t in every(0.02, 4.5)[1:]]
    meter = looked_at(stamps, every(0.1, 14.5))
    assert meter.hz(T0 + 14.5) == pytest.approx(50, rel=0.01)


def test_a_clock_that_is_set_back_spoils_nothing() -> None:
    meter = looked_at(every(0.1, 3), every(0.1, 3))
    for n in range(20):
        meter.add([Arrival(T0 - 3600 + n / 10, 8)])
    now_s = T0 - 3600 + 2
    assert meter.hz(now_s) == pytest.approx(10)
    assert meter.age_s(now_s - 1) == 0.0


def test_two_messages_of_one_stamp_are_no_division_by_zero() -> None:
    meter = RateMeter()
    meter.add([Arrival(T0, 8)])
    meter.add([Arrival(T0, 8)])
    assert meter.hz(T0) is None
