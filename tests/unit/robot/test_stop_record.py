"""Whatever order stops and releases become known in, all nodes end alike, and no stop is lost."""

from __future__ import annotations

import random
from itertools import permutations
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.safety.stop_record import (
    MOST_HELD,
    MOST_RELEASED,
    Insistence,
    Stop,
    StopRecord,
    read_record,
)

S = 1_000_000_000
NODES = 4
nodes = st.integers(0, NODES - 1)
clocks = st.sampled_from([0, -3600 * S, 3600 * S, 40 * S])
"""Two hosts, and two more that nobody has set right."""
words = st.tuples(st.sampled_from(["stop", "release"]), clocks, st.sets(nodes, min_size=1))
"""What a person says, by which clock, and which nodes hear it themselves."""
passed_on = st.tuples(st.just("state"), nodes, nodes)
restarts = st.tuples(st.just("restart"), nodes, st.booleans())
histories = st.lists(words | passed_on | restarts, max_size=20)


class Fleet:
    """Some nodes, two disks, and what was ever on the wire: any of that may arrive again."""

    def __init__(self) -> None:
        self.known = [StopRecord() for _ in range(NODES)]
        self.disks = [StopRecord(), StopRecord()]
        self.wire: list[tuple[int, StopRecord]] = []
        self.time_ns = 1000 * 3600 * S

    def say(self, what: str, clock_ns: int, hearers: set[int]) -> None:
        self.time_ns += S
        stop = Stop(self.time_ns + clock_ns, 1)
        for node in hearers:
            record = self.known[node]
            self.learn(node, record.stopped(stop) if what == "stop" else record.freed())

    def learn(self, node: int, record: StopRecord) -> None:
        self.known[node] = self.known[node].merged(record)
        self.wire.append((node, self.known[node]))
        if node != NODES - 1:  # The last one has no disk.
            self.disks[node % 2] = self.disks[node % 2].merged(self.known[node])

    def restart(self, node: int, has_disk: bool) -> None:
        self.known[node] = self.disks[node % 2] if has_disk and node != NODES - 1 else StopRecord()

    def settle(self, dice: random.Random) -> None:
        """Everybody hears everybody, at first among late and repeated news."""
        for late in (self.wire, [], []):
            news = [*late, *enumerate(self.known)]
            dice.shuffle(news)
            for _, record in news:
                for node in dice.sample(range(NODES), NODES):
                    self.known[node] = self.known[node].merged(record)

    def play(self, history: list[tuple[Any, ...]]) -> None:
        for what, first, second in history:
            if what == "state":
                self.learn(second, self.known[first])
            elif what == "restart":
                self.restart(first, second)
            else:
                self.say(what, first, second)


@given(histories, st.randoms(use_true_random=False))
def test_all_who_hear_of_each_other_end_alike(
    history: list[tuple[Any, ...]], dice: random.Random
) -> None:
    fleet = Fleet()
    fleet.play(history)
    fleet.settle(dice)
    assert all(record == fleet.known[0] for record in fleet.known)


@given(histories, clocks, nodes, st.randoms(use_true_random=False))
def test_the_last_stop_is_never_lost_whatever_was_released_before(
    history: list[tuple[Any, ...]], clock_ns: int, hearer: int, dice: random.Random
) -> None:
    fleet = Fleet()
    fleet.play(history)
    fleet.say("stop", clock_ns, {hearer})
    fleet.settle(dice)
    assert all(record.engaged for record in fleet.known)


@given(histories, nodes, st.randoms(use_true_random=False))
def test_a_release_that_comes_after_all_is_known_frees_all(
    history: list[tuple[Any, ...]], hearer: int, dice: random.Random
) -> None:
    fleet = Fleet()
    fleet.play(history)
    fleet.settle(dice)
    fleet.say("release", 0, {hearer})
    fleet.settle(dice)
    assert not any(record.engaged for record in fleet.known)


def test_a_release_by_one_who_has_not_heard_of_the_stop_does_not_undo_it() -> None:
    first, second = Stop(5 * S, 1), Stop(3 * S, 1)  # The second by a clock that is slow.
    released = StopRecord().stopped(first).freed()
    unaware = StopRecord().stopped(first, second)
    assert released.merged(unaware).held == {second}
    assert unaware.merged(released) == released.merged(unaware)


def test_a_late_copy_of_a_released_stop_is_no_new_one() -> None:
    stop = Stop(5 * S, 1)
    freed = StopRecord().stopped(stop).freed()
    assert not freed.stopped(stop).engaged
    assert freed.stopped(Stop(5 * S, 2)).engaged


@given(st.integers(1, 200), st.integers(1, 200))
def test_it_stays_small_and_stopped_however_often_a_stop_is_said(count: int, again: int) -> None:
    record = StopRecord()
    for number in range(count):
        record = record.stopped(Stop(number * S, number + 1))
        if number % again == again - 1:
            record = record.freed()
    assert len(record.held) <= MOST_HELD
    assert len(record.released) <= MOST_RELEASED
    assert record.engaged == bool(count % again)


@given(histories)
def test_as_text_and_back(history: list[tuple[Any, ...]]) -> None:
    fleet = Fleet()
    fleet.play(history)
    for record in fleet.known:
        assert read_record(**record.texts()) == record


@pytest.mark.parametrize(
    "text", ["", "x", "1.", ".1", "-1.2", "1.2.3", "1e9.0", "9" * 400 + ".1", "²³.1", "1:2", "::."]
)
def test_what_makes_no_sense_is_left_out(text: str) -> None:
    assert read_record(text, text) == StopRecord()
    assert read_record(f"{text} 7.1", f"{text} 1:7.2").held == {Stop(7, 1)}


# ---------------------------------------------------------------- contradictions


def insisting(interval_s: float, count: int) -> Insistence:
    insistence = Insistence()
    for number in range(1, count + 1):
        insistence.hear([Stop(int(number * interval_s * S), number)], number * interval_s)
    return insistence


@pytest.mark.parametrize("interval_s", [0.01, 0.1, 1.0, 5.0])
def test_against_who_keeps_saying_stop_a_release_by_another_counts_for_nothing(
    interval_s: float,
) -> None:
    insistence, now_s = insisting(interval_s, 3), 3 * interval_s
    assert insistence.lasts(now_s + interval_s, 1)
    assert not insistence.lasts(now_s + 2 * interval_s + 0.6, 1)


def test_a_stop_that_is_pressed_twice_is_released_at_once() -> None:
    assert not insisting(0.3, 2).lasts(0.6, 1)


def test_stops_of_one_message_each_insist_on_nothing() -> None:
    insistence = Insistence()
    for number in range(9):
        insistence.hear([Stop(number * S, 1)], float(number))
    assert not insistence.lasts(9.0, 1)


def test_who_has_insisted_may_release_by_the_next_message() -> None:
    assert not insisting(0.1, 5).lasts(0.51, 6)


@pytest.mark.parametrize("order", list(permutations(["stop", "release"])))
@pytest.mark.parametrize("ahead", [0, 1, 2])
def test_two_who_contradict_each_other_at_one_rate_end_in_a_stop(
    order: tuple[str, str], ahead: int
) -> None:
    insistence, obeyed = Insistence(), []
    for number in range(1, 30):
        now_s = number * 0.1
        for word in order:
            if word == "stop":
                insistence.hear([Stop(int(now_s * S), number)], now_s)
            else:
                obeyed.append(not insistence.lasts(now_s, number + ahead))
    assert not any(obeyed[5:])
