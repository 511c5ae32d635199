"""The Space screen: what is subscribed to, camera by keys and mouse, layers, frames."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
from textual.events import MouseScrollUp
from textual.pilot import Pilot

from graph.data import GraphUpdate, Trouble
from space.drawing.camera import Angle
from space.drawing.paints import Tint
from space.transform import Transform
from tests.tui.recorded import RecordedGraph, lesson_update
from tests.tui.recorded_lesson import sample, topic
from tests.tui.recorded_space import STRING, frame_row, frames, marker_sample, space_update
from tests.tui.space.stage_runs import at_work, robot_in_a_room
from text.i18n import set_language
from tui.dialogs.choice import ChoiceScreen
from tui.session.messages import SessionChanged
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


async def test_another_screen_needs_none_of_them() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (_screen, pilot):
        await pilot.press("5")
        await pilot.pause()
        assert opener.graph.watched.isdisjoint({"/depth/points", "/map"})
        assert "/markers" not in opener.graph.followed


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


async def test_a_click_on_the_mark_hides_a_layer() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        await pilot.click(LayerRows, offset=(3, 1))
        await pilot.pause()
        assert "/cliff" not in opener.graph.watched
        assert rows_of(screen).splitlines()[1].split()[:2] == ["▶", "○"]


async def test_only_one_layer() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        screen.layer_rows.choose("/scan")
        await pilot.press("o")
        await pilot.pause()
        assert opener.graph.watched == {"/scan"}
        assert not screen.stage.show_frames


async def test_a_layer_that_is_not_joined_says_which_transform_is_missing() -> None:
    apart = tuple(row for row in frames() if row.newest.child != "laser")
    async with at_work(robot_in_a_room(space_update(None, apart))) as (screen, _pilot):
        layer = screen.stage.layers.get("/scan")
        assert layer is not None
        assert layer.apart == "not joined to map: there is no frame laser"
        assert "there is no frame" in " ".join(rows_of(screen).split())


@pytest.mark.parametrize(
    ("name", "more", "said", "rests"),
    [
        ("/goal_pose", {"age_s": None}, "no message yet", True),
        ("/scan", {"age_s": None}, "there is a publisher,", False),
        ("/odom", {"age_s": None}, "there is a publisher,", False),
        ("/plan", {"age_s": 9.0, "steady_hz": 1.0}, "no data for 9 s", False),
        ("/plan", {"age_s": 9.0, "steady_hz": None}, "no data for 9 s", True),
    ],
)
async def test_only_what_comes_all_the_time_is_missed(
    name: str, more: dict[str, Any], said: str, rests: bool
) -> None:
    silent = space_update({name: {"trouble": Trouble.QUIET, "hz": None, **more}})
    samples = {key: found for key, found in silent.samples.items() if key != name}
    opener = robot_in_a_room(replace(silent, samples=samples))
    async with at_work(opener) as (screen, _pilot):
        lines = [line.strip(" │▶") for line in rows_of(screen).splitlines()]
        at = next(number for number, line in enumerate(lines) if line.startswith(f"● {name}"))
        assert lines[at + 1] == said
        layer = screen.stage.layers.get(name)
        assert layer is not None
        assert layer.rests is rests


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


async def test_two_trees_are_told_apart() -> None:
    rows = (*frames(), frame_row("world", "thing", Transform()))
    async with at_work(robot_in_a_room(space_update(None, rows))) as (screen, _pilot):
        assert screen.stage.fixed == "map"
        assert "not joined to map: thing," in " ".join(rows_of(screen).split())
        assert "thing" not in text_of(screen)


async def test_a_frame_that_has_gone_is_not_drawn_any_more() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        assert "camera_link" in text_of(screen)
        fewer = tuple(row for row in frames() if row.newest.child != "camera_link")
        await show(pilot, opener.graph, space_update(None, fewer))
        assert "camera_link" not in text_of(screen)


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


async def test_a_moved_camera_stays_while_the_robot_moves_on() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        await pilot.press("plus", "plus")
        camera = screen.view.camera
        await show(pilot, opener.graph, space_update())
        assert screen.view.camera == camera


async def test_the_angle_goes_round_and_ctrl_arrows_turn_the_perspective() -> None:
    async with at_work() as (screen, pilot):
        angles = []
        for _press in range(3):
            await pilot.press("alt+v")
            angles.append(screen.view.camera.angle)
        assert angles == [Angle.SIDE, Angle.PERSPECTIVE, Angle.ABOVE]
        await pilot.press("alt+v", "alt+v")
        before = screen.view.camera
        await pilot.press("ctrl+left", "ctrl+up")
        after = screen.view.camera
        assert after.yaw_rad != before.yaw_rad
        assert after.pitch_rad > before.pitch_rad
        assert after.target == before.target


async def test_the_wheel_zooms_about_the_pointer() -> None:
    async with at_work() as (screen, pilot):
        view = screen.view
        await pilot.hover(SpaceView, offset=(10, 5))
        place = view.pointer_place
        scale = view.camera.dots_per_m
        await pilot._post_mouse_events([MouseScrollUp], SpaceView, offset=(10, 5))
        await pilot.pause()
        assert view.camera.dots_per_m == pytest.approx(scale * 1.25)
        assert view.pointer_place == pytest.approx(place)


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


async def test_a_topic_of_another_type_than_before_is_named() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        rows = {"/scan": {"type_names": ("std_msgs/msg/String",)}}
        await show(pilot, opener.graph, space_update(rows))
        assert "its type is no longer" in " ".join(rows_of(screen).split())


async def test_a_new_session_begins_with_an_empty_space() -> None:
    opener = robot_in_a_room()
    async with at_work(opener) as (screen, pilot):
        first = screen.stage
        screen.post_message(SessionChanged())
        await pilot.pause()
        assert screen.stage is not first


async def test_hostile_names_are_shown_harmlessly() -> None:
    rows = (*frames(), frame_row("base_link", "\x1b[31mred\n", Transform((0.5, 1.0, 0.0))))
    update = lesson_update(topics=(topic("/evil", "nav_msgs/msg/Path", 1.0, 8),))
    async with at_work(robot_in_a_room(replace(update, frames=rows))) as (screen, _pilot):
        assert "\x1b" not in text_of(screen)
        assert "red" in text_of(screen)
