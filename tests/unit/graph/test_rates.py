"""Rates, jitter and latency from a few looks a second: exact, whatever the looks or clocks."""

from __future__ import annotations

import random
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.messages.stamps import delay_s
from graph.observer.rates import Arrival, RateMeter

T0 = 1_700_000_000.0


def looked_at(stamps: list[float], looks: list[float], *, depth: int = 1000, numbered: bool = True) -> RateMeter:
    meter, waiting = RateMeter(), list(enumerate(stamps))
    for look in looks:
        come = [(n, stamp) for n, stamp in waiting if stamp <= look]
        waiting = waiting[len(come) :]
        batch = [Arrival(T0 + s, 8, n if numbered else None) for n, s in come[-depth:]]
        meter.add(batch, overflowed=len(come) >= depth)
    return meter


def every(period_s: float, until_s: float, phase_s: float = 0.0) -> list[float]:
    return [phase_s + n * period_s for n in range(int((until_s - phase_s) / period_s) + 1)]


@given(hz=st.floats(0.5, 500), look_s=st.floats(0.05, 0.5), phase_s=st.floats(0, 0.05))
def test_a_steady_rate_is_exact_however_it_is_looked_at(hz: float, look_s: float, phase_s: float) -> None:
    meter = looked_at(every(1 / hz, 10, phase_s), every(look_s, 10))
    assert meter.hz(T0 + 10) == pytest.approx(hz, rel=0.001)


@given(hz=st.floats(20, 200), look_s=st.floats(0.2, 0.5), depth=st.integers(3, 5))
def test_a_rate_is_right_though_the_queue_keeps_only_the_newest(hz: float, look_s: float, depth: int) -> None:
    meter = looked_at(every(1 / hz, 10), every(look_s, 10), depth=depth)
    assert meter.hz(T0 + 10) == pytest.approx(hz, rel=0.001)
    assert meter.bytes_per_s(T0 + 10) == pytest.approx(8 * hz, rel=0.001)


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


def test_a_clock_that_is_set_back_spoils_nothing() -> None:
    meter = looked_at(every(0.1, 3), every(0.1, 3))
    for n in range(20):
        meter.add([Arrival(T0 - 3600 + n / 10, 8)])
    now_s = T0 - 3600 + 2
    assert meter.hz(now_s) == pytest.approx(10)
    assert meter.age_s(now_s - 1) == 0.0


def fed(
    arrivals: list[Arrival], per_batch: int, *, overflowed: bool = False, one_publisher: bool = True
) -> RateMeter:
    """A meter that was given the arrivals so many at a time."""
    meter = RateMeter()
    for start in range(0, len(arrivals), per_batch):
        batch = arrivals[start : start + per_batch]
        meter.add(batch, overflowed=overflowed, one_publisher=one_publisher)
    return meter


def swaying(count: int, sway_s: float) -> list[Arrival]:
    """Twenty a second, each second one late."""
    return [Arrival(T0 + n / 20 + (n % 2) * sway_s, 8, n + 1) for n in range(count)]


@given(sway_s=st.floats(0.0, 0.04), per_batch=st.integers(1, 30))
def test_jitter_is_the_deviation_of_the_time_between_messages(sway_s: float, per_batch: int) -> None:
    meter = fed(swaying(61, sway_s), per_batch)
    assert meter.jitter_s(T0 + 3) == pytest.approx(sway_s, abs=1e-6)


def test_messages_that_are_missing_make_no_jitter() -> None:
    """Our queue kept the last three of ten, and one in the middle was lost on the way."""
    steady = [Arrival(T0 + n / 100, 8, n) for n in range(400) if n % 10 >= 7 and n != 158]
    meter = fed(steady, 3, overflowed=True)
    assert meter.jitter_s(T0 + 4) == pytest.approx(0.0, abs=1e-6)


def test_latency_is_the_mean_of_the_last_seconds() -> None:
    chance = random.Random(1)
    arrivals = [
        Arrival(T0 + n / 50, 8, n, (0.2 if n < 100 else 0.01) + chance.uniform(-0.005, 0.005)) for n in range(400)
    ]
    meter = fed(arrivals, 10)
    assert meter.latency_s(T0 + 8) == pytest.approx(0.01, abs=0.001)
    assert meter.latency_s(T0 + 20) is None
    assert fed([Arrival(T0, 8)], 1).latency_s(T0) is None


def test_what_was_lost_on_the_way_is_not_taken_for_ours() -> None:
    """A full queue: of thirty numbers three came, seven were lost, and twenty were ours."""
    meter = RateMeter()
    meter.add([Arrival(T0, 8, 1)])
    meter.add([Arrival(T0 + 0.3, 8, n) for n in (29, 30, 31)], overflowed=True, lost=7)
    assert meter.count == 24


@pytest.mark.parametrize(("order", "head"), [("<", b"\0\1\0\0"), (">", b"\0\0\0\0")])
def test_a_stamp_is_read_in_both_byte_orders(order: str, head: bytes) -> None:
    raw = head + struct.pack(f"{order}iI", 1_700_000_000, 250_000_000) + b"the rest"
    assert delay_s(raw, T0 + 0.5) == pytest.approx(0.25)
    assert delay_s(raw, T0 + 0.125) == pytest.approx(-0.125)


@pytest.mark.parametrize("off_s", [601.0, -602.0, T0])
def test_a_stamp_of_another_clock_is_no_latency_but_tells_how_far_off_it_is(off_s: float) -> None:
    meter = RateMeter()
    meter.add([Arrival(T0, 8, 1, 0.25), Arrival(T0 + 0.1, 8, 2, off_s)])
    assert meter.latency_s(T0 + 0.2) == pytest.approx(0.25)
    assert meter.clock_off_s(T0 + 0.2) == off_s
    meter.add([Arrival(T0 + 0.2, 8, 3, 0.25)])
    assert meter.clock_off_s(T0 + 0.3) is None


def numbered(meter: RateMeter, *sequences: int, every_s: float = 0.1) -> float:
    """Let messages with these numbers come; return when the last did."""
    for step, sequence in enumerate(sequences):
        meter.add([Arrival(T0 + step * every_s, 8, sequence)], one_publisher=False)
    return T0 + (len(sequences) - 1) * every_s


@pytest.mark.parametrize(
    ("sequences", "several"),
    [
        ((1, 2, 3, 4, 5, 6, 7, 8), False),
        ((41, 5, 42, 6, 43, 7, 44, 8), True),
        ((5, 5, 6, 6, 7, 7, 8, 8), True),
        # One that was started again, twice.
        ((7, 8, 1, 2, 3, 1, 2, 3), False),
    ],
)
def test_numbers_that_go_back_again_and_again_are_of_several_publishers(
    sequences: tuple[int, ...], several: bool
) -> None:
    meter = RateMeter()
    now_s = numbered(meter, *sequences)
    assert meter.several_send(now_s) is several
    assert not meter.several_send(now_s + 5.0)


def test_what_was_regular_is_known_once_it_stops() -> None:
    meter = RateMeter()
    last_s = numbered(meter, *range(30))
    assert meter.steady_hz(last_s) is None
    assert meter.steady_hz(last_s + 5.0) == pytest.approx(10.0)
    # A single message after the pause is no rate.
    meter.add([Arrival(last_s + 6.0, 8, 31)])
    assert meter.steady_hz(last_s + 20.0) is None
