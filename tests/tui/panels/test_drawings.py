"""Wheels and head: which wheel is slower, where the head looks, in numbers and a word."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from robot.kinematics import WHEEL_RADIUS_M, wheel_speeds
from tests.tui.panel_stage import alone, rows
from tui.panels.head import HeadReading, HeadView, head_in
from tui.panels.wheels import WheelsReading, WheelsView, wheels_in

NAMES = ["rear_left_wheel_joint", "rear_right_wheel_joint", "steering_joint"]


def turning(speed: float, steering: float) -> WheelsReading:
    speeds = wheel_speeds(speed, steering)
    return WheelsReading(speeds.left_m_s, speeds.right_m_s, steering)


def joint_state(**more: Any) -> dict[str, Any]:
    value = {
        "name": NAMES,
        "position": np.array([0.0, 0.0, 0.5]),
        "velocity": np.array([0.2508, 0.3492, 0.0]) / WHEEL_RADIUS_M,
        "effort": np.array([]),
    }
    return {**value, **more}


def test_a_joint_state_is_read_by_the_names_of_its_joints() -> None:
    wheels = wheels_in(joint_state())
    assert wheels is not None
    assert wheels.left_m_s == pytest.approx(0.2508)
    assert wheels.right_m_s == pytest.approx(0.3492)
    assert wheels.radius_m == pytest.approx(0.4576, abs=1e-4)
    mixed = wheels_in(joint_state(name=NAMES[::-1], position=[0.5, 0, 0], velocity=[0, 9, 8]))
    assert mixed == WheelsReading(8 * WHEEL_RADIUS_M, 9 * WHEEL_RADIUS_M, 0.5)


@pytest.mark.parametrize(
    "value",
    [
        {},
        {"name": ["pan_joint"]},
        joint_state(velocity=[], position=[]),
        joint_state(velocity=[math.inf] * 3, position=[math.nan] * 3),
        joint_state(name=NAMES[:1]),
    ],
)
async def test_whatever_comes_is_shown(value: dict[str, Any]) -> None:
    wheels = wheels_in(value)
    view = WheelsView()
    async with alone(view, 40, 12).run_test(size=(60, 30)):
        if wheels is not None:
            view.show(wheels)
            assert any("---" in row for row in rows(view))


@pytest.mark.parametrize(
    ("speed", "steering", "words"),
    [
        (0.3, 0.5, "left wheel slower"),
        (0.3, -0.5, "right wheel slower"),
        (-0.3, 0.5, "left wheel slower"),
        (0.5, 0.0, "straight"),
        (-0.3, 0.0, "straight back"),
        (0.0, 0.5, "standing"),
    ],
)
def test_a_word_says_which_wheel_is_slower(speed: float, steering: float, words: str) -> None:
    assert turning(speed, steering).words == words


@pytest.mark.parametrize(("width", "height"), [(34, 5), (44, 14)])
async def test_both_speeds_are_numbers_at_every_size(width: int, height: int) -> None:
    view = WheelsView()
    async with alone(view, width, height).run_test(size=(100, 40)):
        view.show(turning(0.3, 0.5))
        shown = "\n".join(rows(view))
        assert all(words in shown for words in ("0.25 m/s", "0.35 m/s", "left wheel slower"))


def test_radians_become_degrees_left_and_up() -> None:
    value = {"name": ["tilt_joint", "pan_joint"], "position": [math.pi / 18, math.pi / 4]}
    pose = head_in(value)
    assert pose is not None
    assert (pose.pan_words, pose.tilt_words) == ("45° left", "10° up")
    assert (HeadReading(-45, 0).pan_words, HeadReading(0, -10).tilt_words) == ("45° right", "10° down")
    assert HeadReading(0.2, -0.2).pan_words == "0°"


async def test_it_moves_while_the_pose_changes_and_rests_when_it_does_not() -> None:
    view = HeadView()
    async with alone(view, 44, 10).run_test(size=(60, 30)):
        for pan, words in ((0, "at rest"), (10, "moving"), (10, "at rest")):
            view.show(HeadReading(pan, 0))
            assert words in "\n".join(rows(view))


async def test_a_head_that_nobody_knows_of_does_not_move() -> None:
    """Servos tell nothing: before the first turn, and after their cable was pulled."""
    view = HeadView()
    async with alone(view, 24, 4).run_test(size=(60, 30)):
        for pan, words in ((math.nan, "unknown until it turns"), (10, "at rest"), (math.nan, "---")):
            view.show(HeadReading(pan, pan))
            assert words in "\n".join(rows(view))


async def test_what_it_was_told_and_the_answer_are_shown_harmlessly() -> None:
    view = HeadView()
    async with alone(view, 60, 10).run_test(size=(80, 30)):
        view.show(HeadReading(0, 0))
        view.command(HeadReading(-90, 15))
        assert "commanded: 90° right, 15° up" in "\n".join(rows(view))
        view.answer("[red]no[/red]\x1b[31m")
        assert "[red]no[/red]␛[31m" in "\n".join(rows(view))
        view.command(HeadReading(0, 0))
        assert "[red]" not in "\n".join(rows(view))
