"""When a node that ended is started again, and when that is given up."""

from __future__ import annotations

import pytest

from launcher.supervisor.restart_policy import (
    CRASH_WINDOW_S,
    LAST_DELAY_S,
    MAX_CRASHES,
    STABLE_S,
    Again,
    Finished,
    GivenUp,
    RestartPolicy,
)


@pytest.mark.parametrize(
    ("kind", "clean", "verdict"),
    [
        ("never", True, Finished()),
        ("never", False, GivenUp(1)),
        ("on-failure", True, Finished()),
        ("on-failure", False, Again(1.0)),
        ("always", True, Again(1.0)),
        ("always", False, Again(1.0)),
    ],
)
def test_the_first_end(kind: str, clean: bool, verdict: object) -> None:
    assert RestartPolicy(kind).after(clean=clean, lasted_s=0.1, now=0.0) == verdict


def test_the_delay_doubles_up_to_its_bound() -> None:
    policy = RestartPolicy("on-failure")
    now = 0.0
    delays = []
    for _crash in range(8):
        verdict = policy.after(clean=False, lasted_s=STABLE_S - 1, now=now)
        assert isinstance(verdict, Again)
        delays.append(verdict.delay_s)
        now += CRASH_WINDOW_S
    assert delays == [1, 2, 4, 8, 16, LAST_DELAY_S, LAST_DELAY_S, LAST_DELAY_S]


def test_a_crash_loop_is_given_up() -> None:
    policy = RestartPolicy("on-failure")
    now = 0.0
    for _crash in range(MAX_CRASHES - 1):
        verdict = policy.after(clean=False, lasted_s=0.0, now=now)
        assert isinstance(verdict, Again)
        now += verdict.delay_s
    assert policy.after(clean=False, lasted_s=0.0, now=now) == GivenUp(MAX_CRASHES, now)


def test_a_node_that_ran_well_for_a_while_begins_anew() -> None:
    policy = RestartPolicy("on-failure")
    for crash in range(MAX_CRASHES - 1):
        policy.after(clean=False, lasted_s=0.0, now=float(crash))
    assert policy.after(clean=False, lasted_s=STABLE_S, now=40.0) == Again(1.0)


def test_a_start_by_hand_begins_anew() -> None:
    policy = RestartPolicy("on-failure")
    for crash in range(MAX_CRASHES - 1):
        policy.after(clean=False, lasted_s=0.0, now=float(crash))
    policy.reset()
    assert policy.after(clean=False, lasted_s=0.0, now=10.0) == Again(1.0)
