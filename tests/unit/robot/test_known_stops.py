"""A release frees what was known before it was said, however late it is heard."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from safety.known_stops import LATE_NS, Heard, KnownStops
from safety.stop_record import Stop, StopRecord

S = 1_000_000_000
HOUR_NS = 3600 * S
NODES = 3
nodes = st.integers(0, NODES - 1)
clocks = st.sampled_from([0, 0, 0, -HOUR_NS, HOUR_NS])
arrivals = st.sampled_from([(0,), (0,), (1,), (2,), (3,), (0, 2), ()])
"""After how many further events a node hears it: late, twice, or never."""
words = st.tuples(st.sampled_from(["stop", "release"]), clocks, st.tuples(arrivals, arrivals, arrivals))
others = st.one_of(
    st.tuples(st.sampled_from(["freeze", "thaw", "restart", "disk"]), nodes, st.booleans()),
    st.tuples(st.just("state"), nodes, nodes),
)
pauses_ns = st.sampled_from([S // 1000, S // 10, S // 2, S, 4 * S])
histories = st.lists(st.tuples(pauses_ns, words | words | others), min_size=3, max_size=12)


class Word:
    """A message on /emergency_stop."""

    def __init__(self, what: str, said_ns: int, clock_ns: int) -> None:
        self.what, self.said_ns = what, said_ns
        self.stop = Stop(said_ns + clock_ns, 1)


class Computer:
    """Three nodes and their disk; time is that of this computer, publishers may have another."""

    def __init__(self) -> None:
        self.nodes = [KnownStops() for _ in range(NODES)]
        self.disk, self.written_ns = StopRecord(), 0
        self.inboxes: list[list[Word] | None] = [None] * NODES
        """What waits for a frozen node; None for one that is awake."""
        self.said: list[Word] = []
        self.underway: list[tuple[int, int, Word]] = []
        """After which event which node will hear what."""
        self.events = 0
        self.time_ns = 1000 * HOUR_NS
        self.ages_ns: list[set[int]] = [set() for _ in range(NODES)]

    def play(self, pause_ns: int, what: str, first: Any, second: Any) -> None:
        self.time_ns += pause_ns
        self.events += 1
        self.act(what, first, second)
        due = [one for one in self.underway if one[0] <= self.events]
        self.underway = [one for one in self.underway if one[0] > self.events]
        for _, node, word in due:
            self.give(node, word, late=word.said_ns < self.time_ns)

    def act(self, what: str, first: Any, second: Any) -> None:
        if what in ("stop", "release"):
            word = Word(what, self.time_ns, first)
            self.said.append(word)
            self.underway += [
                (self.events + after, node, word) for node, arrivals in enumerate(second) for after in arrivals
            ]
        elif what == "state" and self.inboxes[first] is self.inboxes[second] is None:
            self.nodes[second].learn(self.nodes[first].record, self.time_ns)
        elif what == "freeze" and self.inboxes[first] is None:
            self.inboxes[first] = []
        elif what == "thaw":
            waiting, self.inboxes[first] = self.inboxes[first] or [], None
            for word in waiting if second else reversed(waiting):
                self.hear(first, word, was_frozen=True)
        elif what == "restart":
            self.nodes[first], self.inboxes[first] = KnownStops(), None
            self.nodes[first].learn(self.disk, self.written_ns)
        elif what == "disk" and self.inboxes[first] is None:
            self.nodes[first].learn(self.disk, self.written_ns)
            self.disk = self.disk.merged(self.nodes[first].record)
            self.written_ns = self.time_ns

    def give(self, node: int, word: Word, *, late: bool = False) -> None:
        inbox = self.inboxes[node]
        if inbox is not None:
            inbox.append(word)
            return
        if late:  # No network delays two releases equally.
            while any(abs(self.time_ns - word.stop.said_ns - age_ns) <= S for age_ns in self.ages_ns[node]):
                self.time_ns += S
        self.hear(node, word, was_frozen=False)

    def hear(self, node: int, word: Word, *, was_frozen: bool) -> None:
        known = self.nodes[node]
        if word.what == "stop":
            known.learn(StopRecord().stopped(word.stop), self.time_ns)
            return
        known.learn(self.disk, self.written_ns)
        heard = Heard(word.stop.said_ns, self.time_ns)
        self.ages_ns[node].add(heard.age_ns)
        known.release(heard, was_frozen=was_frozen)

    def freed_by_nobody(self) -> list[Stop]:
        """The stops that count as released, though nobody has released them since."""
        last_ns = max((word.said_ns for word in self.said if word.what == "release"), default=0)
        younger = {word.stop for word in self.said if word.what == "stop" if word.said_ns > last_ns}
        records = [self.disk, *(known.record for known in self.nodes)]
        return [stop for record in records for stop in younger & record.released.keys()]


@settings(max_examples=1500)
@given(histories)
def test_a_stop_that_is_younger_than_the_last_release_is_released_by_nobody(
    history: list[tuple[int, tuple[Any, ...]]],
) -> None:
    computer = Computer()
    for pause_ns, (what, first, second) in history:
        computer.play(pause_ns, what, first, second)
        assert computer.freed_by_nobody() == []


@given(histories, nodes)
def test_a_release_that_is_heard_in_time_frees_all_that_was_known(
    history: list[tuple[int, tuple[Any, ...]]], hearer: int
) -> None:
    computer = Computer()
    for pause_ns, (what, first, second) in history:
        computer.play(pause_ns, what, first, second)
    known = computer.nodes[hearer]
    known.learn(computer.disk, computer.written_ns)
    now_ns = computer.time_ns + S
    assert known.release(Heard(now_ns, now_ns + S // 100))
    assert not known.record.engaged


def after(*stops_ns: int, seen_ns: int) -> KnownStops:
    known = KnownStops()
    known.learn(StopRecord().stopped(*(Stop(said_ns, 1) for said_ns in stops_ns)), seen_ns)
    return known


BASE_NS = 1000 * HOUR_NS


@pytest.mark.parametrize("late_ns", [S // 10, LATE_NS, 5 * S, HOUR_NS])
def test_a_release_that_was_said_before_the_stop_frees_nothing(late_ns: int) -> None:
    known = after(BASE_NS, seen_ns=BASE_NS + S // 100)
    known.release(Heard(BASE_NS - S // 20, BASE_NS - S // 20 + late_ns))
    assert known.record.engaged


def test_stop_and_release_of_one_moment_are_told_apart_by_when_they_were_said() -> None:
    known = after(BASE_NS, seen_ns=BASE_NS + S // 100)
    assert known.release(Heard(BASE_NS + 1, BASE_NS + S // 100))
    assert not known.record.engaged


@pytest.mark.parametrize("clock_ns", [-HOUR_NS, -5 * S, S, HOUR_NS])
def test_another_clock_is_known_by_its_second_release(clock_ns: int) -> None:
    known = after(BASE_NS, seen_ns=BASE_NS)
    for at_ns, is_placed in ((S, False), (2 * S, True)):
        assert known.release(Heard(BASE_NS + at_ns + clock_ns, BASE_NS + at_ns)) is is_placed
        assert known.record.engaged is not is_placed


@pytest.mark.parametrize("frozen", [(True, True), (True, False), (False, True)])
def test_what_has_waited_for_a_frozen_process_tells_of_no_clock(frozen: tuple[bool, bool]) -> None:
    known = after(BASE_NS + 3 * S, seen_ns=BASE_NS + 3 * S)
    for said_ns, was_frozen in zip((BASE_NS, BASE_NS + S), frozen, strict=True):
        known.release(Heard(said_ns, said_ns + 6 * S), was_frozen=was_frozen)
    assert known.record.engaged


def test_after_the_clock_was_set_back_the_second_release_frees() -> None:
    known = after(BASE_NS + 3 * HOUR_NS, seen_ns=BASE_NS + 3 * HOUR_NS)
    for seconds, frees in ((1, False), (2, True)):
        at_ns = BASE_NS + seconds * S
        assert known.release(Heard(at_ns, at_ns + 1)) is frees
        assert known.record.engaged is not frees
