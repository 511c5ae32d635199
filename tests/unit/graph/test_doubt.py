"""When a second observer looks, and when it takes over: bounded, and never to and fro."""

from __future__ import annotations

import itertools

from graph.observer.census import Census
from graph.observer.doubt import (
    FIRST_AGAIN_S,
    LAST_AGAIN_S,
    LASTS_S,
    LOOKS_FOR_S,
    SURE_S,
    Doubt,
    SecondLook,
)

ROBOT, SCREEN = b"robot", b"screen"


def looks(doubt: Doubt, found: Census, from_s: float, to_s: float) -> list[float]:
    """When a second observer looks, each time in vain, while this is seen."""
    times = []
    now_s = from_s
    while now_s < to_s:
        doubt.see(found, now_s)
        if doubt.is_due(now_s, found.is_networked):
            times.append(now_s)
            now_s += LOOKS_FOR_S
            doubt.nothing_found(now_s)
        now_s += 1.0
    return times


def test_a_process_that_is_there_and_not_seen_is_looked_for_once() -> None:
    doubt = Doubt(0.0)
    times = looks(doubt, Census(frozenset({SCREEN}), frozenset({7})), 0.0, 3600.0)
    assert times == [LASTS_S]
    doubt.see(Census(frozenset({SCREEN}), frozenset({7, 8})), 3600.0)
    assert not doubt.is_due(3600.0, is_networked=False)
    assert doubt.is_due(3600.0 + LASTS_S, is_networked=False)


def test_one_that_is_seen_a_little_later_is_not_looked_for() -> None:
    doubt = Doubt(0.0)
    for now_s in range(100):
        # A node that starts each second, and is seen three seconds later.
        doubt.see(Census(frozenset({SCREEN}), frozenset(range(now_s - 3, now_s))), float(now_s))
        assert not doubt.is_due(float(now_s), is_networked=False)


def test_after_a_cut_of_the_network_it_is_looked_again_and_again_ever_more_seldom() -> None:
    doubt = Doubt(0.0)
    doubt.see(Census(frozenset({ROBOT, SCREEN}), is_networked=True), 0.0)
    times = looks(doubt, Census(frozenset({SCREEN}), is_networked=True), 100.0, 4000.0)
    gaps = [later - sooner for sooner, later in itertools.pairwise(times)]
    assert times[0] <= 100.0 + LASTS_S + 1.0
    assert gaps[0] <= FIRST_AGAIN_S + LOOKS_FOR_S + 1.0
    assert all(gap <= LAST_AGAIN_S + LOOKS_FOR_S + 1.0 for gap in gaps[:10])
    assert gaps[-1] > 4 * LAST_AGAIN_S


def test_who_finds_others_by_itself_is_not_doubted() -> None:
    doubt = Doubt(0.0)
    doubt.see(Census(frozenset({ROBOT}), is_networked=True), 0.0)
    doubt.see(Census(is_networked=True), 10.0)
    doubt.see(Census(frozenset({ROBOT}), is_networked=True), 12.0)
    assert looks(doubt, Census(frozenset({ROBOT}), is_networked=True), 13.0, 500.0) == []


def test_on_one_machine_a_node_that_has_left_is_no_reason() -> None:
    doubt = Doubt(0.0)
    doubt.see(Census(frozenset({ROBOT, SCREEN})), 0.0)
    assert looks(doubt, Census(), 1.0, 1000.0) == []


def test_only_one_that_surely_sees_more_takes_over() -> None:
    less, more, other = (Census(frozenset(known)) for known in ([ROBOT], [ROBOT, SCREEN], [SCREEN]))
    look = SecondLook(0.0)
    assert not look.sees_more(less, less, 1.0)
    assert not look.sees_more(less, more, 2.0)
    # The first has found it in the meantime.
    assert not look.sees_more(more, more, 3.0)
    assert not look.sees_more(less, more, 4.0)
    assert not look.sees_more(less, other, 5.0)
    assert not look.sees_more(less, more, 6.0)
    assert look.sees_more(less, more, 6.0 + SURE_S)
    assert not look.is_over(LOOKS_FOR_S - 1.0)
    assert look.is_over(LOOKS_FOR_S)
