"""The keys that drive: what they ask for, and that silence always ends it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.publishing.dead_man_switch import CommandRepeater, HeldCommand
from robot.limits import SPEED, STEERING
from robot.words import STOP, DriveSetpoint
from tui.teleop.keys import FIRST_HOLD_S, NEXT_HOLD_S, NOTHING, Move, Teleop, TeleopLimits
from tui.teleop.route import RATE_HZ, command

LIMITS = TeleopLimits()
REPEAT_S = 0.033


def held(keys: Teleop, move: Move, from_s: float, for_s: float) -> Teleop:
    """A key held as a terminal tells of it: pressed, half a second of silence, repeated."""
    keys = keys.pressed(move, from_s)
    at_s = from_s + 0.5
    while at_s < from_s + for_s:
        assert keys.at(at_s) is not NOTHING
        keys = keys.pressed(move, at_s)
        at_s += REPEAT_S
    return keys


def test_a_key_drives_through_the_silence_before_it_repeats() -> None:
    keys = Teleop().pressed(Move.FORWARD, 10.0)
    assert keys.at(10.5).setpoint(LIMITS) == DriveSetpoint(0.2, 0.0)
    assert keys.at(10.0 + FIRST_HOLD_S).setpoint(LIMITS) == STOP


def test_a_key_that_repeats_is_up_soon_after_the_last_repetition() -> None:
    keys = held(Teleop(), Move.BACK, 10.0, 3.0)
    assert keys.at(13.0).setpoint(LIMITS) == DriveSetpoint(-0.2, 0.0)
    assert keys.at(13.0 + NEXT_HOLD_S) is NOTHING


def test_left_while_it_goes_forward_is_a_curve_for_as_long_as_left_is_held() -> None:
    keys = held(Teleop(), Move.FORWARD, 10.0, 1.0)
    keys = held(keys, Move.LEFT, 11.0, 1.0)
    assert keys.at(12.0).setpoint(LIMITS) == DriveSetpoint(0.2, 0.3)
    assert keys.at(12.0 + NEXT_HOLD_S) is NOTHING


def test_forward_after_left_is_a_curve_too() -> None:
    keys = held(Teleop().pressed(Move.RIGHT, 10.0), Move.FORWARD, 10.2, 2.0)
    assert keys.at(12.2).setpoint(LIMITS) == DriveSetpoint(0.2, -0.3)


def test_forward_once_more_in_a_curve_is_straight_on() -> None:
    keys = Teleop().pressed(Move.FORWARD, 10.0).pressed(Move.LEFT, 10.2)
    assert keys.pressed(Move.FORWARD, 10.4).setpoint(LIMITS) == DriveSetpoint(0.2, 0.0)
    assert keys.pressed(Move.BACK, 10.4).setpoint(LIMITS) == DriveSetpoint(-0.2, 0.3)


def test_a_key_that_was_up_begins_anew() -> None:
    keys = Teleop().pressed(Move.FORWARD, 10.0).pressed(Move.LEFT, 12.0)
    assert keys.setpoint(LIMITS) == DriveSetpoint(0.0, 0.3)
    assert keys.until_s == 12.0 + FIRST_HOLD_S


def test_the_limits_stay_within_what_a_robot_may_be_asked() -> None:
    assert TeleopLimits() == TeleopLimits(0.2, 0.3)
    limits = TeleopLimits()
    speeds = []
    for _press in range(8):
        limits = limits.faster(1).sharper(1)
        speeds.append(limits.speed_m_s)
    assert speeds == [0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.5, 0.5]
    assert limits == TeleopLimits(SPEED.high, STEERING.high)
    assert limits.faster(-99).sharper(-99) == TeleopLimits(0.05, 0.05)


moments = st.lists(st.tuples(st.floats(0.0, 1.0), st.sampled_from(Move)), min_size=1, max_size=60)


@given(moments, st.floats(0.0, 5.0))
def test_no_keys_and_no_silence_leave_a_command_behind(
    history: list[tuple[float, Move]], later_s: float
) -> None:
    keys, now_s = Teleop(), 100.0
    for pause_s, move in history:
        now_s += pause_s
        keys = keys.pressed(move, now_s)
        asked = keys.setpoint(LIMITS)
        assert asked != STOP
        assert asked.speed_m_s in SPEED
        assert asked.steering_rad in STEERING
        assert keys.until_s <= now_s + FIRST_HOLD_S
    over_s = now_s + FIRST_HOLD_S + later_s
    assert keys.at(over_s).setpoint(LIMITS) == STOP


@given(moments, st.floats(0.001, 0.3))
def test_what_goes_out_is_a_stop_when_the_last_key_is_over(
    history: list[tuple[float, Move]], look_every_s: float
) -> None:
    sent: list[tuple[float, Mapping[str, Any]]] = []
    keys, now_s = Teleop(), 100.0
    repeater = CommandRepeater(lambda value: sent.append((now_s, value)))
    for pause_s, move in history:
        quiet_until_s = now_s + pause_s
        while now_s + look_every_s < quiet_until_s:
            now_s += look_every_s
            repeater.step(now_s)
        now_s = quiet_until_s
        keys = keys.pressed(move, now_s)
        drive = HeldCommand(command(keys.setpoint(LIMITS)), command(STOP), RATE_HZ, keys.until_s)
        repeater.hold(drive, now_s)
    last_key_s = now_s
    for _look in range(int(3.0 / look_every_s)):
        now_s += look_every_s
        repeater.step(now_s)
    moving = [at for at, value in sent if value != command(STOP)]
    assert moving
    assert moving[-1] < last_key_s + FIRST_HOLD_S
    assert sent[-1][1] == command(STOP)
    assert sent[-1][0] - last_key_s == pytest.approx(0.0, abs=FIRST_HOLD_S + 3 * 0.35)
