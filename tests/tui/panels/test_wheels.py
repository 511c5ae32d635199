"""The wheels from above: which is slower is seen by bars, numbers and a word."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from graph.data import Trouble
from robot.kinematics import WHEEL_RADIUS_M, wheel_speeds
from tests.tui.panel_stage import alone, rows
from tui.panels.dots import rectangle
from tui.panels.wheels.chassis import speed_bar
from tui.panels.wheels.reading import WheelsReading, wheels_in
from tui.panels.wheels.widget import WheelsView

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


@pytest.mark.parametrize(("width", "height"), [(60, 1), (34, 5), (44, 14)])
async def test_an_angle_that_no_wheel_can_have_is_named(width: int, height: int) -> None:
    view = WheelsView()
    async with alone(view, width, height).run_test(size=(100, 40)):
        for steering, words in ((1e308, "1e308"), (-1e308, "-1e308"), (7.0, "7")):
            view.show(WheelsReading(0.3, 0.3, steering))
            shown = "\n".join(rows(view))
            if height > 1:
                assert f"out of range: {words} rad" in shown


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


@pytest.mark.parametrize(("width", "height"), [(60, 1), (34, 5), (44, 14), (80, 30)])
async def test_both_speeds_are_numbers_at_every_size(width: int, height: int) -> None:
    view = WheelsView()
    async with alone(view, width, height).run_test(size=(100, 40)):
        view.show(turning(0.3, 0.5))
        shown = "\n".join(rows(view))
        assert all(words in shown for words in ("0.25 m/s", "0.35 m/s", "left wheel slower"))
        if height > 1:
            assert "29° left" in shown
            assert "R 0.46 m" in shown


def test_the_bar_of_the_faster_wheel_is_longer_and_backwards_hangs_down() -> None:
    def cells(speed: float) -> list[bool]:
        return [bool(line[0].look != "muted") for line in speed_bar(speed, 0.5, 10, "accent")]

    assert sum(cells(0.25)) < sum(cells(0.35))
    assert cells(0.25)[-1]
    assert not cells(0.25)[0]
    assert cells(-0.25)[0]
    assert not cells(-0.25)[-1]
    assert sum(cells(0.5)) == 10
    assert sum(cells(0.0)) == 0


def test_the_front_wheels_turn_to_the_side_that_is_steered_to() -> None:
    corners = rectangle((10.0, 10.0), 2.0, 8.0, 0.5)
    front = min(corners, key=lambda corner: corner[1])
    assert front[0] < 10.0


async def test_old_speeds_are_greyed_with_their_age() -> None:
    view = WheelsView()
    async with alone(view, 44, 14).run_test(size=(60, 30)):
        view.show(turning(0.3, 0.5))
        view.show_trouble(Trouble.QUIET, "", 5.0)
        assert "no data for 5 s" in rows(view)[-1]
        looks = {ink.look for line in view._lines for ink in line if ink.text.strip()}
        assert looks == {"muted", "alert"}
