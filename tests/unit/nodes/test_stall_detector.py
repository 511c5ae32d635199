"""What a process that was stopped finds in its queues is not taken for new."""

from __future__ import annotations

import time
from dataclasses import dataclass

import pytest

from nodes.parts.stall_detector import StallDetector


@dataclass
class Stamp:
    """As in a message's header."""

    sec: int
    nanosec: int


def stamp(age_s: float) -> Stamp:
    now_ns = time.time_ns() - int(age_s * 1e9)
    return Stamp(*divmod(now_ns, 10**9))


@pytest.fixture
def woken(monkeypatch: pytest.MonkeyPatch) -> StallDetector:
    """One who was away for 2 s and came back this moment."""
    stalls = StallDetector()
    now_s = time.monotonic() + 2.0
    monkeypatch.setattr(time, "monotonic", lambda: now_s)
    assert stalls.lasted(0.5)
    return stalls


def later(monkeypatch: pytest.MonkeyPatch, by_s: float) -> None:
    now_s = time.monotonic() + by_s
    monkeypatch.setattr(time, "monotonic", lambda: now_s)


def test_who_was_not_away_takes_everything_in() -> None:
    stalls = StallDetector()
    assert not stalls.lasted(0.5)
    assert not stalls.kept_waiting(stamp(0.4))


def test_just_awake_it_takes_nothing_in(
    woken: StallDetector, monkeypatch: pytest.MonkeyPatch
) -> None:
    later(monkeypatch, 0.4)
    assert woken.lasted(0.5)
    later(monkeypatch, 0.2)
    assert not woken.lasted(0.5)


def test_what_was_sent_meanwhile_is_known_by_its_stamp_though_it_comes_late(
    woken: StallDetector, monkeypatch: pytest.MonkeyPatch
) -> None:
    later(monkeypatch, 0.8)
    assert woken.lasted(1.0) is False
    assert woken.kept_waiting(stamp(0.9))
    assert not woken.kept_waiting(stamp(0.7))


def test_a_stamp_that_says_nothing_is_not_asked(
    woken: StallDetector, monkeypatch: pytest.MonkeyPatch
) -> None:
    later(monkeypatch, 0.4)
    assert not woken.kept_waiting(Stamp(0, 0))
    assert not woken.kept_waiting(stamp(3600.0))


def test_a_clock_that_is_behind_is_believed_again_after_a_while(
    woken: StallDetector, monkeypatch: pytest.MonkeyPatch
) -> None:
    later(monkeypatch, 2.0)
    assert woken.kept_waiting(stamp(5.0))
    later(monkeypatch, 2.0)
    assert not woken.kept_waiting(stamp(5.0))
