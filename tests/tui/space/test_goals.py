"""Goals and initial poses: published where they are aimed, and never by accident."""

from __future__ import annotations

import math
from typing import Any

import pytest
from textual.pilot import Pilot

from tests.tui.recorded import RecordedOpener
from tests.tui.space.stage_runs import at_work, robot_in_a_room
from tests.tui.space.test_screen import drag
from tui.space.screen import SpaceScreen
from tui.space.view import SpaceView

pytestmark = pytest.mark.nightly

GOAL, POSE = "/goal_pose", "geometry_msgs/msg/PoseStamped"
INITIAL, WITH_COVARIANCE = "/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped"
START, END = (30, 12), (40, 12)


def goals(opener: RecordedOpener) -> list[tuple[str, str, Any]]:
    """What was published about places."""
    return [sent[:3] for sent in opener.graph.published if sent[0] in {GOAL, INITIAL}]


def place_at(screen: SpaceScreen, cell: tuple[int, int]) -> tuple[float, float]:
    """The place on the floor below the middle of a cell."""
    view = screen.view
    found = view.camera.floor_at(2 * cell[0] + 1, 4 * cell[1] + 2, *view.dots)
    assert found is not None
    return found


def heading_of(pose: Any) -> float:
    """The yaw of a pose."""
    turn = pose["orientation"]
    assert turn["x"] == turn["y"] == 0.0
    return 2 * math.atan2(turn["z"], turn["w"])


def banner(screen: SpaceScreen) -> str:
    """The band that says what is armed; empty if it is not there."""
    band = screen.query_one("#space-armed")
    return str(band.render()) if band.display else ""


def told(pilot: Pilot[Any]) -> str:
    """All notifications."""
    return " ".join(note.message for note in pilot.app._notifications)


async def test_a_goal_is_published_by_press_and_drag() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        place = place_at(screen, START)
        await pilot.press("alt+g")
        await pilot.pause()
        place = place_at(screen, START)
        await drag(pilot, START, (START[0], START[1] - 5))
        ((topic, kind, message),) = goals(opener)
        assert (topic, kind, message["header"]["frame_id"]) == (GOAL, POSE, "map")
        found = message["pose"]["position"]
        assert (found["x"], found["y"], found["z"]) == pytest.approx((*place, 0.0))
        assert heading_of(message["pose"]) == pytest.approx(math.pi / 2)
        assert not screen.armed
        assert "Published on /goal_pose" in told(pilot)


async def test_an_initial_pose_is_published_with_the_covariance_of_rviz() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (_screen, pilot):
        await pilot.press("alt+i")
        await pilot.pause()
        await drag(pilot, START, (START[0] - 8, START[1]))
        ((topic, kind, message),) = goals(opener)
        assert (topic, kind) == (INITIAL, WITH_COVARIANCE)
        inner = message["pose"]
        assert abs(heading_of(inner["pose"])) == pytest.approx(math.pi)
        assert len(inner["covariance"]) == 36
        assert {0, 7, 35} == {at for at, value in enumerate(inner["covariance"]) if value}


async def test_a_goal_is_published_by_keys_alone() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        x, y, _z = screen.view.camera.target
        await pilot.press("alt+g")
        await pilot.pause()
        step = 2 / screen.view.camera.dots_per_m
        await pilot.press("right", "right", "right", "down", *["ctrl+left"] * 3, "enter")
        await pilot.pause()
        ((_topic, _kind, message),) = goals(opener)
        found = message["pose"]["position"]
        assert (found["x"], found["y"]) == pytest.approx((x + 3 * step, y - step))
        assert heading_of(message["pose"]) == pytest.approx(math.pi / 4)


async def test_nothing_is_published_unless_armed() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        assert banner(screen) == ""
        await drag(pilot, START, END)
        await pilot.press("enter")
        await pilot.click(SpaceView, offset=START)
        await pilot.pause()
        assert goals(opener) == []


async def test_escape_and_another_screen_disarm() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        for leave in ("escape", "5"):
            await pilot.press("9", "alt+g")
            await pilot.pause()
            assert screen.armed
            await pilot.press(leave)
            await pilot.pause()
            assert not screen.armed
        assert goals(opener) == []


async def test_the_emergency_stop_disarms_and_refuses() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        await pilot.press("alt+g", "space")
        await pilot.pause()
        assert not screen.armed
        await pilot.press("alt+g")
        await pilot.pause()
        assert not screen.armed
        assert banner(screen) == ""
        await pilot.press("enter")
        assert "The emergency stop is engaged" in told(pilot)
        assert goals(opener) == []


async def test_the_emergency_stop_between_drag_and_publishing_wins() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        await pilot.press("alt+g")
        await pilot.mouse_down(SpaceView, offset=START)
        await pilot.hover(SpaceView, offset=END)
        await pilot.press("space")
        await pilot.mouse_up(SpaceView, offset=END)
        await pilot.pause()
        assert goals(opener) == []
        assert not screen.armed
