"""Whether the observer's process hangs, on a machine that is busy or was asleep."""

from __future__ import annotations

from graph.observer.vigil import GIVEN_UP_AFTER_S, HUNG_AFTER_S, LOOK_S, OLD_AFTER_S, Vigil


def idle() -> bool:
    return False


def busy() -> bool:
    return True


def looked_at(vigil: Vigil, from_s: float, to_s: float, ready: bool) -> float | None:
    """Look all the time; return when it is said to hang."""
    now_s = from_s
    while now_s <= to_s:
        if vigil.hangs(now_s, busy if ready else idle):
            return now_s
        now_s += LOOK_S
    return None


def test_what_is_known_is_old_once_no_sign_has_come_for_a_while() -> None:
    vigil = Vigil(0.0)
    vigil.sign(10.0)
    assert vigil.old_since_s(10.0 + OLD_AFTER_S) is None
    assert vigil.old_since_s(10.1 + OLD_AFTER_S) == 10.0
    vigil.sign(20.0)
    assert vigil.old_since_s(20.1) is None


def test_one_that_could_run_and_does_not_hangs() -> None:
    ended_s = looked_at(Vigil(0.0), 0.0, 100.0, ready=False)
    assert ended_s is not None
    assert HUNG_AFTER_S < ended_s <= HUNG_AFTER_S + 2 * LOOK_S


def test_one_that_only_lacks_a_processor_does_not_hang_for_a_minute() -> None:
    ended_s = looked_at(Vigil(0.0), 0.0, 100.0, ready=True)
    assert ended_s is not None
    assert ended_s > GIVEN_UP_AFTER_S


def test_time_in_which_the_screen_itself_was_stopped_does_not_count() -> None:
    vigil = Vigil(0.0)
    assert not vigil.hangs(0.5, idle)
    assert not vigil.hangs(50.0, idle)
    assert not vigil.hangs(50.5, idle)
    assert looked_at(vigil, 51.0, 70.0, ready=False) is not None
