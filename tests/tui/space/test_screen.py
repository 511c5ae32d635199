"""The Space screen: what is subscribed to, its camera, and goals, published never by accident."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from textual.pilot import Pilot

from graph.data import GraphUpdate
from graph.observer.requests import Publish
from space.drawing.paints import Tint
from tests.tui.recorded import RecordedGraph, RecordedOpener
from tests.tui.recorded_space import SPACE_TOPICS, frames, space_update
from tests.tui.space.stage_runs import at_work, robot_in_a_room
from tui.session.past import TRENDS
from tui.space.rows import LayerRows
from tui.space.screen import SpaceScreen
from tui.space.view import SpaceView

WATCHED = {row.name for row in SPACE_TOPICS} - {"/markers"}


def text_of(screen: SpaceScreen) -> str:
    view = screen.view
    return "\n".join(view.render_line(y).text for y in range(view.size.height))


def rows_of(screen: SpaceScreen) -> str:
    rows = screen.query_one(LayerRows)
    return "\n".join(rows.render_line(y).text.rstrip() for y in range(rows.size.height))


def tints(screen: SpaceScreen) -> set[int]:
    view = screen.view
    picture = screen.stage.picture(view.aim, view.camera, *view.size)
    return {*picture.front.ravel().tolist(), *picture.back.ravel().tolist()}


async def show(pilot: Pilot[Any], graph: RecordedGraph, update: GraphUpdate) -> None:
    graph.show(update)
    await pilot.pause()
    await pilot.pause()


async def test_layers_come_from_the_types_of_the_topics() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, _pilot):
        assert opener.graph.wanted.watched == WATCHED | set(TRENDS)
        assert "/markers" in opener.graph.wanted.followed
        shown = rows_of(screen)
        for name in ("frames", "/map", "/markers", "/scan"):
            assert name in shown


async def test_a_hidden_layer_is_neither_drawn_nor_subscribed_to() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        assert Tint.WALL in tints(screen)
        screen.layer_rows.choose("/map")
        await pilot.press("m")
        await pilot.pause()
        assert Tint.WALL not in tints(screen)
        assert "/map" not in opener.graph.wanted.watched
        await pilot.press("a")
        await pilot.pause()
        assert "/map" in opener.graph.wanted.watched
        await show(pilot, opener.graph, space_update())
        assert Tint.WALL in tints(screen)


async def test_a_layer_that_is_not_joined_says_which_transform_is_missing() -> None:
    apart = tuple(row for row in frames() if row.newest.child != "laser")
    async with at_work(robot_in_a_room(space_update(None, apart))) as (screen, _pilot):
        layer = screen.stage.layers.get("/scan")
        assert layer is not None
        assert layer.apart == "not joined to map: there is no frame laser"
        assert "there is no frame" in " ".join(rows_of(screen).split())


async def test_a_layer_that_cannot_be_read_does_not_stop_the_others() -> None:
    update = space_update()
    broken = replace(update.samples["/map"][0], value={"header": 5})
    samples = {**update.samples, "/map": (broken,)}
    async with at_work(robot_in_a_room(replace(update, samples=samples))) as (screen, _pilot):
        assert "the message has no field" in " ".join(rows_of(screen).split())
        assert Tint.WALL not in tints(screen)
        assert "base_link" in text_of(screen)


async def test_arrows_zoom_and_fit_move_the_camera() -> None:
    async with at_work() as (screen, pilot):
        fitted = screen.view.camera
        await pilot.press("right", "up", "plus")
        camera = screen.view.camera
        assert camera.x_m > fitted.x_m
        assert camera.y_m > fitted.y_m
        assert camera.dots_per_m > fitted.dots_per_m
        await pilot.press("home")
        await pilot.pause()
        assert screen.view.camera == fitted


async def drag(pilot: Pilot[Any], start: tuple[int, int], end: tuple[int, int]) -> None:
    await pilot.mouse_down(SpaceView, offset=start)
    await pilot.hover(SpaceView, offset=end)
    await pilot.mouse_up(SpaceView, offset=end)
    await pilot.pause()


GOAL, POSE = "/goal_pose", "geometry_msgs/msg/PoseStamped"
INITIAL, WITH_COVARIANCE = "/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped"
START, END = (30, 12), (40, 12)


def goals(opener: RecordedOpener) -> list[tuple[str, str, Any]]:
    return [sent[:3] for sent in opener.graph.asked(Publish) if sent[0] in {GOAL, INITIAL}]


def place_at(screen: SpaceScreen, cell: tuple[int, int]) -> tuple[float, float]:
    """The place on the floor below the middle of a cell."""
    view = screen.view
    return view.camera.floor_at(2 * cell[0] + 1, 4 * cell[1] + 2, *view.dots)


def heading_of(pose: Any) -> float:
    turn = pose["orientation"]
    assert turn["x"] == turn["y"] == 0.0
    return 2 * math.atan2(turn["z"], turn["w"])


def told(pilot: Pilot[Any]) -> str:
    return " ".join(note.message for note in pilot.app._notifications)


async def test_a_goal_is_published_by_press_and_drag() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        await drag(pilot, START, END)
        await pilot.press("enter")
        assert goals(opener) == [], "nothing is armed"
        await pilot.press("home", "alt+g")
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


@pytest.mark.nightly
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


@pytest.mark.nightly
async def test_a_goal_is_published_by_keys_alone() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        x, y = screen.view.camera.x_m, screen.view.camera.y_m
        await pilot.press("alt+g")
        await pilot.pause()
        step = 2 / screen.view.camera.dots_per_m
        await pilot.press("right", "right", "right", "down", *["ctrl+left"] * 3, "enter")
        await pilot.pause()
        ((_topic, _kind, message),) = goals(opener)
        found = message["pose"]["position"]
        assert (found["x"], found["y"]) == pytest.approx((x + 3 * step, y - step))
        assert heading_of(message["pose"]) == pytest.approx(math.pi / 4)


@pytest.mark.nightly
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
        await pilot.press("alt+g")
        await pilot.mouse_down(SpaceView, offset=START)
        await pilot.hover(SpaceView, offset=END)
        await pilot.press("space")
        await pilot.mouse_up(SpaceView, offset=END)
        await pilot.pause()
        assert not screen.armed
        await pilot.press("alt+g", "enter")
        await pilot.pause()
        assert not screen.armed
        assert "The emergency stop is engaged" in told(pilot)
        assert goals(opener) == []
