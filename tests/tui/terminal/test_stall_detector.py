"""A process that was held up: noticed by a thread, or by the first who asks."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator

import pytest

from tests.waiting import wait_until
from tui import clock
from tui.terminal.stall_detector import DRAIN_S, LONGEST_S, KeyStallDetector

STARTED_S = 1.0
WOKE_S = STARTED_S + 6.0


@pytest.fixture
def move_hand(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], None]:
    """Set the clock that stands."""

    def set_to(to_s: float) -> None:
        monkeypatch.setattr(clock, "steady", lambda: to_s)

    return set_to


@pytest.fixture
def detector(move_hand: Callable[[float], None]) -> Iterator[KeyStallDetector]:
    move_hand(STARTED_S)
    made = KeyStallDetector()
    yield made
    made.end()


def test_no_stamp_is_believed_for_a_moment_after_it(
    detector: KeyStallDetector, move_hand: Callable[[float], None]
) -> None:
    assert not detector.may_precede(STARTED_S)
    move_hand(WOKE_S)
    assert detector.may_precede(WOKE_S)
    move_hand(WOKE_S + DRAIN_S)
    assert detector.may_precede(WOKE_S + DRAIN_S - 0.1)
    assert not detector.may_precede(WOKE_S + DRAIN_S)


def test_a_machine_that_is_busy_is_no_stall(
    detector: KeyStallDetector, move_hand: Callable[[float], None]
) -> None:
    for stall in range(1, 5):
        at_s = STARTED_S + stall * (LONGEST_S - 0.1)
        move_hand(at_s)
        assert not detector.may_precede(at_s)


def test_it_is_noticed_though_nobody_asks_and_no_thread_is_left_behind(
    detector: KeyStallDetector, move_hand: Callable[[float], None]
) -> None:
    detector.watch()
    move_hand(WOKE_S)
    wait_until(lambda: detector.woke_s == WOKE_S, "it is noticed")
    detector.end()
    wait_until(
        lambda: "stall-detector" not in [each.name for each in threading.enumerate()],
        "it has ended",
    )
