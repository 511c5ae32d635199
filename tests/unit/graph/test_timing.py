"""Jitter from messages that came one after the other; latency from stamps of the same clock."""

from __future__ import annotations

import random
import statistics
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.messages.stamps import delay_reader, delay_s
from graph.observer.rates import RateMeter
from graph.observer.timing import Arrival, Spread

T0 = 1_700_000_000.0


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
def test_jitter_is_the_deviation_of_the_time_between_messages(
    sway_s: float, per_batch: int
) -> None:
    meter = fed(swaying(61, sway_s), per_batch)
    assert meter.jitter_s(T0 + 3) == pytest.approx(sway_s, abs=1e-6)


def test_messages_that_are_missing_make_no_jitter() -> None:
    """Our queue kept the last three of ten, and one in the middle was lost on the way."""
    steady = [Arrival(T0 + n / 100, 8, n) for n in range(400) if n % 10 >= 7 and n != 158]
    meter = fed(steady, 3, overflowed=True)
    assert meter.jitter_s(T0 + 4) == pytest.approx(0.0, abs=1e-6)


def test_without_numbers_only_what_lay_in_one_queue_is_consecutive() -> None:
    steady = [Arrival(T0 + n / 100, 8) for n in range(400) if n % 10 >= 7]
    full = fed(steady, 3, overflowed=True, one_publisher=False)
    assert full.jitter_s(T0 + 4) == pytest.approx(0.0, abs=1e-6)
    every = [Arrival(T0 + n / 100, 8) for n in range(400)]
    assert fed(every, 1).jitter_s(T0 + 4) == pytest.approx(0.0, abs=1e-6)


def test_numbers_of_two_publishers_say_nothing_of_each_other() -> None:
    two = [Arrival(T0 + n / 20, 8, (n // 2) + 1000 * (n % 2)) for n in range(60)]
    assert fed(two, 5, one_publisher=False).jitter_s(T0 + 3) == pytest.approx(0.0, abs=1e-6)


def test_jitter_takes_more_than_a_few_messages_and_ends_with_them() -> None:
    assert fed(swaying(3, 0.01), 1).jitter_s(T0) is None
    meter = fed(swaying(20, 0.01), 1)
    assert meter.jitter_s(T0 + 1) == pytest.approx(0.01, rel=0.1)
    assert meter.jitter_s(T0 + 10) is None


def test_jitter_follows_a_change_and_keeps_its_digits() -> None:
    arrivals = [*swaying(200, 0.02)]
    calm = [Arrival(T0 + 10 + n / 20, 8, 201 + n) for n in range(100)]
    meter = fed([*arrivals, *calm], 4)
    assert meter.jitter_s(T0 + 15) == pytest.approx(0.0, abs=2e-6)


def test_a_slow_topic_has_a_jitter_too() -> None:
    meter = fed([Arrival(T0 + 10 * n + n % 2, 8, n) for n in range(12)], 1)
    assert meter.jitter_s(T0 + 111) == pytest.approx(1.0, rel=0.01)


def test_a_clock_that_is_set_back_makes_no_interval() -> None:
    meter = fed(swaying(40, 0.0), 5)
    later = [Arrival(T0 - 500 + n / 20, 8, 41 + n) for n in range(20)]
    for arrival in later:
        meter.add([arrival])
    assert meter.jitter_s(T0 - 499) == pytest.approx(0.0, abs=1e-6)


@given(st.lists(st.floats(0.001, 10.0), min_size=3, max_size=50), st.integers(1, 7))
def test_a_spread_is_what_the_library_of_statistics_says(figures: list[float], by: int) -> None:
    spread = Spread()
    for start in range(0, len(figures), by):
        spread.add(T0, figures[start : start + by])
    assert spread.mean_s == pytest.approx(statistics.fmean(figures))
    assert spread.deviation_s == pytest.approx(statistics.pstdev(figures), rel=1e-6, abs=1e-6)


def test_latency_is_the_mean_of_the_last_seconds() -> None:
    chance = random.Random(1)
    arrivals = [
        Arrival(T0 + n / 50, 8, n, (0.2 if n < 100 else 0.01) + chance.uniform(-0.005, 0.005))
        for n in range(400)
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


def test_a_stamp_of_nothing_is_left_out() -> None:
    assert delay_s(b"\0\1\0\0" + struct.pack("<iI", 0, 0), T0) is None


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


def test_several_in_one_look_are_seen_as_well() -> None:
    meter = RateMeter()
    meter.add([Arrival(T0 + n / 100, 8, n // 2 + 30 * (n % 2)) for n in range(10)])
    assert meter.several_send(T0 + 0.2)


def test_what_was_regular_is_known_once_it_stops() -> None:
    meter = RateMeter()
    last_s = numbered(meter, *range(30))
    assert meter.steady_hz(last_s) is None
    assert meter.steady_hz(last_s + 5.0) == pytest.approx(10.0)
    # A single message after the pause is no rate.
    meter.add([Arrival(last_s + 6.0, 8, 31)])
    assert meter.steady_hz(last_s + 20.0) is None


def test_what_comes_now_and_then_was_never_regular() -> None:
    meter = RateMeter()
    for n, at_s in enumerate((0, 0.01, 0.02, 1, 1.01, 1.02, 1.9, 1.91, 1.92, 3, 3.01, 3.02)):
        meter.add([Arrival(T0 + at_s, 8, n)])
    assert meter.steady_hz(T0 + 9.0) is None
    few = RateMeter()
    assert few.steady_hz(numbered(few, *range(9)) + 5.0) is None


def test_a_message_that_ends_in_its_header_is_no_error() -> None:
    assert delay_s(b"\0\1\0\0\1\2", T0) is None
    assert delay_s(b"", T0) is None


def test_only_messages_that_begin_with_a_header_have_one() -> None:
    def kind(**fields: str) -> type:
        return type("Kind", (), {"get_fields_and_field_types": staticmethod(lambda: fields)})

    assert delay_reader(kind(header="std_msgs/Header", data="double")) is delay_s
    assert delay_reader(kind(data="double", header="std_msgs/Header")) is None
    assert delay_reader(kind(markers="sequence<visualization_msgs/Marker>")) is None
    assert delay_reader(kind()) is None
