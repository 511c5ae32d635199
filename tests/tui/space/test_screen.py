"""The Space screen: what is subscribed to, camera by keys and mouse, layers, frames."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from textual.pilot import Pilot

from graph.data import GraphUpdate
from space.drawing.paints import Tint
from space.transform import Transform
from tests.tui.recorded import RecordedGraph
from tests.tui.recorded_lesson import sample
from tests.tui.recorded_space import STRING, frame_row, frames, marker_sample, space_update
from tests.tui.space.stage_runs import at_work, robot_in_a_room
from text.i18n import set_language
from tui.dialogs.choice import ChoiceScreen
from tui.space.rows import LayerRows
from tui.space.screen import SpaceScreen
from tui.space.view import SpaceView

WATCHED = {
    "/cliff",
    "/depth/points",
    "/goal_pose",
    "/map",
    "/odom",
    "/plan",
    "/robot_description",
    "/scan",
    "/sensor/sonar_front",
    "/sensor/sonar_rear",
}


def text_of(screen: SpaceScreen) -> str:
    """The characters of the picture."""
    view = screen.view
    return "\n".join(view.render_line(y).text for y in range(view.size.height))


def rows_of(screen: SpaceScreen) -> str:
    """The list of layers."""
    rows = screen.query_one(LayerRows)
    return "\n".join(rows.render_line(y).text.rstrip() for y in range(rows.size.height))


def tints(screen: SpaceScreen) -> set[int]:
    """The colours in the picture."""
    view = screen.view
    picture = screen.stage.picture(view.camera, *view.size, view.aim)
    return {*picture.front.ravel().tolist(), *picture.back.ravel().tolist()}


async def show(pilot: Pilot[Any], graph: RecordedGraph, update: GraphUpdate) -> None:
    """Let the graph say something new."""
    graph.show(update)
    await pilot.pause()
    await pilot.pause()


async def test_layers_come_from_the_types_of_the_topics() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, _pilot):
        assert opener.graph.watched == WATCHED
        assert "/markers" in opener.graph.followed
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
        assert "/map" not in opener.graph.watched
        await pilot.press("a")
        await pilot.pause()
        assert "/map" in opener.graph.watched
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


LACKING = {
    "mimic": (
        ("continuous", "<mimic joint='elbow'/>", ""),
        "line 2: joint j: there is no joint elbow;",
        "строка 2: сочленение j: сочленения elbow нет;",
    ),
    "material": (
        ("fixed", "", "<material name='paint'/>"),
        "line 3: there is no material paint;",
        "строка 3: материала paint нет;",
    ),
}
"""What a robot's joint and link have, what Space says of it, and that in Russian."""


@pytest.mark.parametrize("lang", ["en", "ru"])
@pytest.mark.parametrize("case", LACKING)
async def test_what_a_description_lacks_is_said_and_the_robot_is_drawn(
    case: str, lang: str
) -> None:
    (kind, mimic, material), *said = LACKING[case]
    text = f"""<robot name='r'><link name='base_link'/><link name='mast'/>
    <joint name='j' type='{kind}'><parent link='base_link'/><child link='mast'/>{mimic}</joint>
    <link name='ball'><visual><geometry><sphere radius='0.4'/></geometry>{material}</visual></link>
    <joint name='k' type='fixed'><parent link='mast'/><child link='ball'/></joint></robot>"""
    described = (sample("/robot_description", STRING, {"data": text}),)
    joined = [frame_row("base_link", link, Transform()) for link in ("mast", "ball")]
    update = space_update(None, (*frames(), *joined), robot_description=described)
    set_language(lang)
    async with at_work(robot_in_a_room(update)) as (screen, _pilot):
        assert said[lang == "ru"] in " ".join(rows_of(screen).split())
        layer = screen.stage.layers.get("/robot_description")
        assert layer is not None
        drawn = {link.frame: link.shapes for link in layer.reader.shown(0.0)}
        assert drawn["ball"]


async def test_arrows_zoom_and_fit_move_the_camera() -> None:
    async with at_work() as (screen, pilot):
        fitted = screen.view.camera
        await pilot.press("right", "up", "plus")
        camera = screen.view.camera
        assert camera.target[0] > fitted.target[0]
        assert camera.target[1] > fitted.target[1]
        assert camera.dots_per_m > fitted.dots_per_m
        await pilot.press("home")
        await pilot.pause()
        assert screen.view.camera == fitted


async def test_a_drag_pans_and_with_shift_turns() -> None:
    async with at_work() as (screen, pilot):
        view = screen.view
        await pilot.press("alt+v", "alt+v")
        before = view.camera
        await drag(pilot, (20, 10), (24, 10))
        moved = view.camera
        assert moved.target != before.target
        assert moved.yaw_rad == before.yaw_rad
        await drag(pilot, (20, 10), (24, 12), shift=True)
        assert view.camera.target == moved.target
        assert view.camera.yaw_rad < moved.yaw_rad


async def drag(
    pilot: Pilot[Any], start: tuple[int, int], end: tuple[int, int], *, shift: bool = False
) -> None:
    """Press the mouse, move it, let it go."""
    await pilot.mouse_down(SpaceView, offset=start, shift=shift)
    await pilot.hover(SpaceView, offset=end)
    await pilot.mouse_up(SpaceView, offset=end, shift=shift)
    await pilot.pause()


async def test_the_line_below_says_where_the_pointer_is() -> None:
    async with at_work() as (screen, pilot):
        view = screen.view
        await pilot.hover(SpaceView, offset=(view.size.width // 2, view.size.height // 2))
        await pilot.pause()
        x, y, _z = view.pointer_place or (math.nan, 0.0, 0.0)
        assert (x, y) == pytest.approx(view.camera.target[:2], abs=4 / view.camera.dots_per_m)
        line = str(screen.query_one("#space-status").render())
        assert f"x {x:.2f}  y {y:.2f} m" in line
        assert "in map" in line


async def test_a_frame_is_followed() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        await pilot.press("alt+t")
        await pilot.pause()
        assert isinstance(pilot.app.screen, ChoiceScreen)
        await pilot.press("down", "enter")
        await pilot.pause()
        assert screen.stage.follow == "base_link"
        there = Transform((3.0, -2.0, 0.0))
        rows = tuple(
            frame_row("odom", "base_link", there, static=False)
            if row.newest.child == "base_link"
            else row
            for row in frames()
        )
        late = tuple(replace(row, newest=replace(row.newest, stamp_s=11.0)) for row in rows)
        await show(pilot, opener.graph, space_update(None, late))
        assert screen.view.camera.target == pytest.approx((3.0, -2.0, 0.0))
        await pilot.press("right")
        moved = screen.view.camera.target
        await show(pilot, opener.graph, space_update(None, late))
        assert screen.view.camera.target == pytest.approx(moved)
        assert "follows base_link" in str(screen.query_one("#space-status").render())


async def test_the_fixed_frame_is_chosen() -> None:
    async with at_work() as (screen, pilot):
        await pilot.press("alt+r")
        await pilot.pause()
        await pilot.press("down", "enter")
        await pilot.pause()
        assert screen.stage.fixed == "base_link"
        assert "in base_link" in str(screen.query_one("#space-status").render())


async def test_without_frames_what_there_is_is_drawn_in_its_own_frame() -> None:
    async with at_work(robot_in_a_room(space_update(None, ()))) as (screen, _pilot):
        assert screen.stage.fixed == "base_link"
        assert "nobody publishes /tf" in rows_of(screen)


async def test_a_marker_is_followed_through_add_and_delete() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        assert "charger" in text_of(screen)
        await show(pilot, opener.graph, space_update(markers=(marker_sample(action=3),)))
        assert "charger" not in text_of(screen)
