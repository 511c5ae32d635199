"""Parts of the screen that need none: keys, bandwidth, estimates, logs of others, driving."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graph.data import Sample
from graph.publishing.dead_man_switch import CommandRepeater, HeldCommand
from robot.limits import SPEED, STEERING
from robot.words import STOP, DriveSetpoint
from tui.actions.layouts import on_all_layouts
from tui.log_view.rows import short_name
from tui.recording.recording import RecordingLimit, read_limit
from tui.session.outside import ROSOUT, RosoutReader
from tui.teleop.keys import FIRST_HOLD_S, NEXT_HOLD_S, NOTHING, RATE_HZ, Move, Teleop, TeleopLimits, command
from tui.terminal.bandwidth import OVER_SSH, SAVED_S, Bandwidth, default_limit


class Clock:
    """Stands still until it is moved."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


@pytest.mark.parametrize(
    ("env", "limit"), [({}, 0), ({"SSH_CONNECTION": ""}, 0), ({"SSH_CONNECTION": "::1 1 ::1 22"}, 40_000)]
)
def test_there_is_a_limit_over_ssh_alone(env: dict[str, str], limit: int) -> None:
    assert default_limit(env) == limit


def test_a_picture_waits_until_what_was_written_is_earned() -> None:
    clock = Clock()
    bandwidth = Bandwidth(40_000, clock)
    bandwidth.written(10_000 + 20_000)
    assert bandwidth.wait_s() == pytest.approx(0.5)
    clock.now_s += 0.4
    assert bandwidth.wait_s() == pytest.approx(0.1)
    clock.now_s += 0.1 + 1e-9
    assert bandwidth.wait_s() == 0


@pytest.mark.parametrize("size", [300, 5_000, 70_000])
def test_pictures_of_any_size_keep_to_the_limit(size: int) -> None:
    clock = Clock()
    bandwidth = Bandwidth(OVER_SSH, clock)
    written, pictures = 0, 0
    while clock.now_s < 160:
        if not (wait_s := bandwidth.wait_s()):
            bandwidth.written(size)
            written, pictures = written + size, pictures + 1
            wait_s = 1 / 200
        clock.now_s += wait_s
    assert written <= OVER_SSH * (60 + SAVED_S) + size
    assert written >= min(OVER_SSH * 60, 60 * 200 * size) * 0.95


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ("x,ч", "x,ч,χ,ס"),
        ("s", "s,ы,і,σ,ד"),
        ("N", "N,Т,Ν"),
        ("alt+v", "alt+v,alt+м,alt+ω,alt+ה"),
        ("f12,slash,ctrl+space,left", "f12,slash,ctrl+space,left"),
    ],
)
def test_the_keys_of_other_layouts_are_those_in_its_place(keys: str, expected: str) -> None:
    assert on_all_layouts(keys) == expected


@pytest.mark.parametrize(
    ("text", "limit"),
    [
        ("", RecordingLimit()),
        ("10", RecordingLimit(seconds=600.0)),
        ("90 s", RecordingLimit(seconds=90.0)),
        (" 1,5 ч ", RecordingLimit(seconds=5400.0)),
        ("10 мин.", RecordingLimit(seconds=600.0)),
        ("500MB", RecordingLimit(bytes=500e6)),
        ("2.5 ГБ", RecordingLimit(bytes=2.5e9)),
    ],
)
def test_a_limit_is_read_in_both_languages(text: str, limit: RecordingLimit) -> None:
    assert read_limit(text) == limit


def message(**value: Any) -> Sample:
    return Sample(ROSOUT, "rcl_interfaces/msg/Log", 1000.0, 0.0, 100, value)


def log(text: str, name: str = "talker", level: int = 20) -> Sample:
    stamp = {"sec": 900, "nanosec": 500_000_000}
    return message(stamp=stamp, level=level, name=name, msg=text, file="", function="", line=1)


def test_a_message_is_a_line_of_its_node_with_the_node_s_own_time() -> None:
    reader = RosoutReader()
    one, two, other = reader.lines([log("a"), log("b"), log("c", name="listener")])
    assert (one.node, one.seq, one.text, one.time_s) == ("talker", 1, "a", 900.5)
    assert (two.seq, other.seq) == (2, 1)
    assert one.logger == "talker"


@given(st.dictionaries(st.sampled_from(["stamp", "level", "name", "msg"]), st.none() | st.text()))
def test_a_topic_of_that_name_with_anything_in_it_breaks_nothing(value: dict[str, Any]) -> None:
    for line in RosoutReader().lines([message(**value)]):
        assert line.time_s == 1000.0


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
def test_no_keys_and_no_silence_leave_a_command_behind(history: list[tuple[float, Move]], later_s: float) -> None:
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


def test_names_of_a_log_are_cut_where_they_stay_apart() -> None:
    left, right = "front_left_wheel_controller", "rear_left_wheel_controller_2"
    cut = [short_name(name, 16) for name in (left, right)]
    assert cut == ["front_left…oller", "rear_left_…ler_2"]
    assert short_name("safety_stop", 11) == "safety_stop"
