"""How the Space screen looks, at three sizes and in both languages."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import replace
from typing import Any

import numpy as np
from textual.pilot import Pilot

from graph.data import GraphUpdate, Trouble
from space.transform import Transform
from tests.tui.recorded_lesson import lesson_update, sample
from tests.tui.recorded_map import NOBODY
from tests.tui.recorded_space import CLOUD, frame_row, frames, scan, space_update
from tests.tui.snapshots import Look, SnapCompare, both_languages, every_look, one_look, settle
from tests.tui.space.stage_runs import robot_in_a_room
from tests.unit.space.trees import cloud_tree

Before = Callable[[Pilot[Any]], Awaitable[None]]


def pressed(*keys: str) -> Before:
    """Wait for the robot, then press keys."""

    async def before(pilot: Pilot[Any]) -> None:
        await settle(pilot)
        await pilot.press(*keys)
        for _round in range(3):
            await pilot.pause()

    return before


@every_look
def test_a_robot_in_a_room_in_perspective(look: Look, snap_compare: SnapCompare) -> None:
    """The room with its walls, the robot and its trail, a cloud, a plan, names of the frames."""
    app = look.app("space", robot_in_a_room())
    assert snap_compare(app, terminal_size=look.size, run_before=pressed("alt+v", "alt+v"))


@every_look
def test_the_same_from_above(look: Look, dump_compare: SnapCompare) -> None:
    """As on a map: everything in its place, the layers beside it with rate and frame."""
    app = look.app("space", robot_in_a_room())
    assert dump_compare(app, terminal_size=look.size, run_before=pressed())


@one_look
def test_the_same_from_the_side(look: Look, dump_compare: SnapCompare) -> None:
    """The floor is a line, above it what stands there."""
    app = look.app("space", robot_in_a_room())
    assert dump_compare(app, terminal_size=look.size, run_before=pressed("alt+v"))


@both_languages
def test_a_goal_is_armed(look: Look, dump_compare: SnapCompare) -> None:
    """A band says that a goal is armed, where, who hears it, and how to leave."""
    app = look.app("space", robot_in_a_room())
    before = pressed("alt+g", "up", "up", "right", "ctrl+left")
    assert dump_compare(app, terminal_size=look.size, run_before=before)


@both_languages
def test_every_trouble_is_said_below_its_layer(look: Look, dump_compare: SnapCompare) -> None:
    """A cloud that is too short, a scan that is not joined, and a silent sonar."""
    app = look.app("space", robot_in_a_room(in_trouble()))
    assert dump_compare(app, terminal_size=look.size, run_before=pressed())


def in_trouble() -> GraphUpdate:
    """The robot with much that is wrong."""
    short = cloud_tree(np.zeros((4, 3)), "camera_link", width=300_000)
    apart = scan()
    lost = {**apart.value, "header": {**apart.value["header"], "frame_id": "lidar"}}  # type: ignore[dict-item]
    rows: dict[str, dict[str, Any]] = {
        "/map": NOBODY,
        "/sensor/sonar_front": {"trouble": Trouble.QUIET, "age_s": 12.0, "hz": None},
    }
    return space_update(
        rows,
        (*frames(), frame_row("world", "lidar", Transform())),
        depth_points=(sample("/depth/points", CLOUD, short),),
        scan=(replace(apart, value=lost),),
    )


@one_look
def test_layers_are_hidden(look: Look, dump_compare: SnapCompare) -> None:
    """Only the map is shown; the others have an empty mark."""
    app = look.app("space", robot_in_a_room())
    before = pressed("tab", "down", "down", "down", "down", "o")
    assert dump_compare(app, terminal_size=look.size, run_before=before)


@one_look
def test_there_is_nothing_to_see(look: Look, dump_compare: SnapCompare) -> None:
    """What would be seen here, and which lessons have it."""
    empty = replace(lesson_update(), topics=(), samples={})
    app = look.app("space", robot_in_a_room(empty))
    assert dump_compare(app, terminal_size=look.size, run_before=pressed())
