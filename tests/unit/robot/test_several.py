"""Several publishers of one input: the most careful counts, whatever the others say and when."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.safety.distance import RangeState, range_state
from robot.safety.several import LowestReading, SlowestCommand, Streams

STALE_S = 0.5


def played(*streams: tuple[float, float, float], until_s: float = 3.0) -> LowestReading:
    """Publishers, each with its period, its distance and when it stops, that speak in turn."""
    seen = LowestReading(0.0)
    said = sorted(
        (count * period_s + index * 0.001, count + 1 + 1000 * index, metres)
        for index, (period_s, metres, end_s) in enumerate(streams)
        for count in range(int(min(end_s, until_s) / period_s) + 1)
    )
    for now_s, number, metres in said:
        seen.see(metres, now_s, number=number, publishers=len(streams))
    return seen


def state_of(seen: LowestReading, now_s: float = 3.0) -> RangeState:
    return range_state(seen.reading(now_s, STALE_S), 0.3, STALE_S)


@pytest.mark.parametrize("fake_period_s", [0.01, 0.05, 0.1, 0.4])
@pytest.mark.parametrize("fake_m", [9.0, math.inf])
def test_the_lowest_counts_whoever_speaks_more_often(fake_period_s: float, fake_m: float) -> None:
    assert state_of(played((0.1, 0.2, 9), (fake_period_s, fake_m, 9))) == RangeState.CLOSE
    assert state_of(played((0.1, 2.0, 9), (fake_period_s, fake_m, 9))) == RangeState.FREE


def test_alone_the_newest_counts() -> None:
    seen = LowestReading(0.0)
    for number, metres in enumerate((0.2, 1.0), 1):
        seen.see(metres, number * 0.01, number=number)
    reading = seen.reading(0.03, STALE_S)
    assert reading.distance_m == 1.0
    assert reading.age_s == pytest.approx(0.01)


def test_a_sensor_without_a_valid_reading_is_not_covered_up() -> None:
    assert state_of(played((0.1, math.nan, 9), (0.05, 9.0, 9))) == RangeState.INVALID


def test_a_single_reading_that_is_lost_is_forgotten_with_the_next() -> None:
    seen = LowestReading(0.0)
    for number in range(1, 40):
        now_s = number * 0.1
        seen.see(math.nan if number == 20 else 2.0, now_s, number=number, publishers=2)
        seen.see(9.0, now_s + 0.01, number=500 + number, publishers=2)
        expected = RangeState.INVALID if number == 20 else RangeState.FREE
        assert state_of(seen, now_s + 0.02) == expected


def test_a_sensor_that_falls_silent_is_not_covered_up() -> None:
    assert state_of(played((0.1, 2.0, 1.5), (0.05, 9.0, 9))) == RangeState.SILENT


def test_a_driver_that_was_started_again_is_no_second_one() -> None:
    """The endpoint of the one that was killed stays in the graph for a while."""
    seen = LowestReading(0.0)
    for number in range(1, 11):
        seen.see(2.0, number * 0.1, number=100 + number)
    for number in range(1, 11):
        seen.see(2.0, 2.0 + number * 0.1, number=number, publishers=2)
    assert state_of(seen, 3.05) == RangeState.FREE


def test_when_the_second_has_left_the_newest_counts_again() -> None:
    seen = played((0.1, 2.0, 9), (0.05, 0.1, 9))
    assert state_of(seen) == RangeState.CLOSE
    seen.see(2.0, 3.01, number=31, publishers=1)
    assert state_of(seen, 3.02) == RangeState.FREE


@given(
    st.lists(
        st.tuples(st.integers(1, 5), st.floats(), st.booleans()),
        min_size=1,
        max_size=60,
    )
)
def test_another_publisher_never_makes_it_bolder(said: list[tuple[int, float, bool]]) -> None:
    """Whatever else is said, what the one sensor has said last is no less dangerous with it."""
    alone, together = LowestReading(0.0), LowestReading(0.0)
    now_s, numbers = 0.0, [0, 1000]
    for ticks, metres, is_other in said:
        now_s += ticks * 0.01
        numbers[is_other] += 1
        together.see(metres, now_s, number=numbers[is_other], publishers=2)
        if not is_other:
            alone.see(metres, now_s, number=numbers[0])
        if state_of(alone, now_s) != RangeState.FREE and numbers[0]:
            assert state_of(together, now_s) != RangeState.FREE


def chosen(*said: tuple[float, float, bool], publishers: int = 2) -> float | None:
    """What counts after these commands: when, how fast, and whether by the other one."""
    slowest: SlowestCommand[float] = SlowestCommand()
    numbers, last = [0, 1000], None
    for now_s, speed, is_other in said:
        numbers[is_other] += 1
        last = slowest.choose(
            speed, speed, now_s, within_s=0.5, number=numbers[is_other], publishers=publishers
        )
    return last


def test_of_several_commands_the_slowest_counts_and_of_opposite_ones_none() -> None:
    assert chosen((0.0, 0.0, False), (0.1, 0.5, True)) == 0.0
    assert chosen((0.0, 0.2, False), (0.1, 0.5, True)) == 0.2
    assert chosen((0.0, -0.2, False), (0.1, -0.1, True)) == -0.1
    assert chosen((0.0, 0.2, False), (0.1, -0.1, True)) is None
    # One that falls silent is not replaced by the other.
    gate = [(0.1 * count, 0.5, False) for count in range(5)]
    foreign = [(0.1 * count + 0.05, 0.5, True) for count in range(15)]
    assert chosen(*sorted(gate + foreign)) is None
    assert chosen((0.0, 0.0, False), (0.1, 0.5, False), publishers=1) == 0.5


def test_streams_keep_apart_by_number() -> None:
    streams: Streams[str] = Streams()
    for number in range(1, 5):
        streams.hear("a", number, number * 0.1)
        streams.hear("b", number + 50, number * 0.1)
    assert sorted(streams.fresh(0.5, 1.0)) == ["a", "b"]
    streams.forget_but_newest()
    assert len(streams.fresh(0.5, 1.0)) == 1


MOCK, REAL = b"mock", b"real"


def two(*, at_once: bool, until_s: float) -> LowestReading:
    """A real sonar at 10 Hz, and a forgotten mock at 0.7 Hz: a second later, or from the start."""
    seen = LowestReading(0.0)
    beside_s = 0.0 if at_once else 2.0
    for tick in range(round(until_s * 10) + 1):
        now_s = tick * 0.1
        here = (
            {REAL: "/sonar_front", MOCK: "/mock"} if now_s >= beside_s else {REAL: "/sonar_front"}
        )
        if tick % 10 == 0:
            seen.are(here, now_s)
        seen.see(0.8, now_s, number=1000 + tick, publishers=len(here))
        if now_s >= beside_s and tick % 14 == 0:
            seen.see(9.0, now_s + 0.01, number=1 + tick // 14, publishers=len(here))
    return seen


def test_who_speaks_too_rarely_is_named_if_it_came_beside_the_other() -> None:
    seen = two(at_once=False, until_s=5.0)
    assert state_of(seen, 5.0) == RangeState.SILENT
    assert seen.too_rare(5.0, STALE_S) == ("/mock",)


def test_of_two_that_were_there_from_the_start_it_is_one() -> None:
    seen = two(at_once=True, until_s=5.0)
    assert state_of(seen, 5.0) == RangeState.SILENT
    assert seen.too_rare(5.0, STALE_S) == ("/mock", "/sonar_front")


def test_if_the_real_one_falls_silent_beside_a_mock_it_is_named_not_the_mock() -> None:
    seen = two(at_once=False, until_s=4.2)
    for count in range(1, 20):
        seen.see(9.0, 4.2 + count * 0.1, number=4 + count, publishers=2)
    assert state_of(seen, 6.1) == RangeState.SILENT
    assert seen.too_rare(6.1, STALE_S) == ("/sonar_front",)


def test_while_all_speak_or_none_does_nobody_is_too_rare() -> None:
    seen = two(at_once=False, until_s=4.2)
    assert seen.too_rare(4.25, STALE_S) == ()
    assert seen.too_rare(9.0, STALE_S) == ()
