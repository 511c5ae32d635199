"""The map, its pure half: where places of the floor are on the canvas, and what is said of them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.motion.odometry import Point, Pose
from robot.world.grid import grid_of
from robot.world.room import LIVING_ROOM
from tui.panels.map.canvas import Canvas
from tui.panels.map.driven_path import LEAST_M, MOST, DrivenPath
from tui.panels.map.layers import Layers
from tui.panels.map.legend import column, entries, rows
from tui.panels.map.reading import OccupancyGrid, goal_in, occupancy_in, pose_in
from tui.panels.map.scene import FRONT, REAR, Scene, draw_scene, robot_corners
from tui.panels.map.viewport import Extent, Viewport, fitted
from tui.widgets.drawing import Line, cells_of
from tui.widgets.scale_bar import bar_length_m, scale_bar

ROOM = Extent(-1.0, 4.0, -2.0, 2.0)
NEST = {"position": {"x": 0.0, "y": 0.0, "z": 0.0}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}
finite = st.floats(-50.0, 50.0)


def grid_message(**more: Any) -> dict[str, Any]:
    grid = grid_of(LIVING_ROOM)
    high, wide = grid.cells.shape
    origin = {**NEST, "position": {"x": grid.x_m, "y": grid.y_m, "z": 0.0}}
    info = {"height": high, "width": wide, "resolution": grid.cell_m, "origin": origin}
    return {"header": {"frame_id": "odom"}, "info": {**info, **more}, "data": grid.cells.ravel()}


def signs(lines: list[Line], char: str) -> list[tuple[int, int]]:
    """Column and row of each cell with this character."""
    texts = ["".join(ink.text for ink in line) for line in lines]
    return [(x, y) for y, text in enumerate(texts) for x, one in enumerate(text) if one == char]


def drawn(scene: Scene, view: Viewport) -> list[Line]:
    canvas = Canvas(view.columns, view.rows)
    draw_scene(canvas, view, scene)
    return canvas.lines()


# ---------------------------------------------------------------- the field


@given(
    finite, finite, st.floats(0.1, 80), st.floats(0.1, 80), st.integers(2, 200), st.integers(1, 60)
)
def test_all_of_an_extent_is_on_the_canvas_and_as_large_as_it_can_be(
    left: float, bottom: float, wide: float, high: float, columns: int, rows: int
) -> None:
    extent = Extent(left, left + wide, bottom, bottom + high)
    view = fitted(extent, columns, rows)
    corners = [view.place(x, y) for x in (left, left + wide) for y in (bottom, bottom + high)]
    assert all(0.0 <= x < 2 * columns and 0.0 <= y < 4 * rows for x, y in corners)
    spans = [max(a) - min(a) for a in zip(*corners, strict=True)]
    assert max(spans[0] / (2 * columns - 1), spans[1] / (4 * rows - 1)) == pytest.approx(1.0)


def test_a_metre_is_as_long_across_as_upwards_with_x_right_and_y_up() -> None:
    view = fitted(ROOM, 60, 12)
    origin = view.place(0.0, 0.0)
    right, up = view.place(1.0, 0.0), view.place(0.0, 1.0)
    assert (
        right[0] - origin[0] == pytest.approx(origin[1] - up[1]) == pytest.approx(view.dots_per_m)
    )
    assert right[1] == origin[1]
    assert up[0] == origin[0]


@pytest.mark.parametrize("dots_per_m", [0.001, 0.3, 2.9, 12.0, 35.0, 900.0])
def test_the_scale_bar_is_as_long_as_it_says(dots_per_m: float) -> None:
    view = Viewport(0.0, 0.0, dots_per_m, 40, 12)
    metres = bar_length_m(view.dots_per_m, 12)
    assert 12 / 2.6 <= metres * dots_per_m / 2 <= 12 + 1e-9
    bar = scale_bar(view.dots_per_m)
    assert abs(len(bar[0].text.rstrip()) - metres * dots_per_m / 2) <= 0.5
    assert bar[1].text == f"{metres:g} m"


def test_an_extent_is_rounded_outwards_so_that_the_view_does_not_creep() -> None:
    assert Extent(-0.2, 2.1, 0.3, 0.4).rounded() == Extent(-1.0, 3.0, 0.0, 1.0)
    assert Extent(-12.0, 2.1, 0.3, 0.4).rounded() == Extent(-20.0, 10.0, 0.0, 10.0)


# ---------------------------------------------------------------- what is drawn


@pytest.mark.parametrize("heading", [0.0, 0.7, math.pi / 2, -2.4, math.pi])
@pytest.mark.parametrize(("place", "offset", "turn"), [(FRONT, 0.3, 0.0), (REAR, 0.05, math.pi)])
def test_a_ray_ends_where_the_sonar_found_something(
    heading: float, place: str, offset: float, turn: float
) -> None:
    view = fitted(Extent(-3, 3, -3, 3), 80, 40)
    lines = drawn(Scene(Pose(0.2, -0.1, heading), rays={place: 1.5}), view)
    x = 0.2 + (1.5 + offset) * math.cos(heading + turn)
    y = -0.1 + (1.5 + offset) * math.sin(heading + turn)
    end = view.place(x, y)
    assert signs(lines, "●") == [(int(end[0]) // 2, int(end[1]) // 4)]


def test_a_robot_that_looks_left_points_up_and_its_nose_is_ahead() -> None:
    view = fitted(ROOM, 40, 16)
    place = view.place(1.0, 0.0)
    nose, *tail = robot_corners(view, Pose(1.0, 0.0, math.pi / 2))
    assert nose[1] < place[1] - 3
    assert nose[0] == pytest.approx(place[0])
    assert all(corner[1] > nose[1] + 4 for corner in tail)
    assert tail[0][0] < tail[2][0], "its left is at the left"


def test_nothing_in_range_is_an_open_cone_and_no_reading_a_broken_mark() -> None:
    view = fitted(Extent(-2, 12, -4, 4), 100, 30)
    free = drawn(Scene(Pose(), rays={FRONT: math.inf}), view)
    assert not signs(free, "●")
    end = int(view.place(8.3, 0.0)[0]) // 2
    reached = [x for x in range(100) for row in free if "".join(i.text for i in row)[x] != " "]
    assert end - 1 <= max(reached) <= end
    blind = drawn(Scene(Pose(), rays={FRONT: math.nan}), view)
    assert len(signs(blind, "?")) == 1
    close = drawn(Scene(Pose(), rays={FRONT: -math.inf}), view)
    bumper = view.place(0.3, 0.0)
    assert signs(close, "●") == [(int(bumper[0]) // 2, int(bumper[1]) // 4)]


@pytest.mark.parametrize("size", [(12, 5), (40, 16), (180, 80)])
def test_the_walls_are_where_the_room_has_them(size: tuple[int, int]) -> None:
    occupancy = occupancy_in(grid_message())
    assert occupancy is not None
    assert occupancy.extent is not None
    view = fitted(occupancy.extent, *size)
    lines = Layers().canvas(view, occupancy, DrivenPath()).lines()
    texts = ["".join(ink.text for ink in line) for line in lines]
    for x_m, y_m, stands in (
        (4.0, 0.0, True),
        (-1.0, 1.0, True),
        (2.2, 0.2, True),
        (3.0, 0.7, False),
    ):
        x, y = view.place(x_m, y_m)
        assert (texts[int(y) // 4][int(x) // 2] != " ") == stands, (x_m, y_m)


def test_a_turned_map_is_turned() -> None:
    turned = {
        **NEST,
        "orientation": {"x": 0, "y": 0, "z": math.sin(math.pi / 4), "w": math.cos(math.pi / 4)},
    }
    cells = np.array([[0, 0, 100]], dtype=np.int8)
    info = {"height": 1, "width": 3, "resolution": 1.0, "origin": turned}
    occupancy = occupancy_in({"header": {"frame_id": "map"}, "info": info, "data": cells.ravel()})
    assert occupancy is not None
    assert occupancy.extent is not None
    assert (occupancy.extent.left_m, occupancy.extent.top_m) == pytest.approx((-1.0, 3.0))
    occupied = occupancy.occupied_at(np.array([-0.5, 2.5]), np.array([2.5, 0.5]))
    assert occupied.tolist() == [True, False]


def test_the_path_is_drawn_on_as_it_would_be_drawn_at_once() -> None:
    view = fitted(ROOM, 30, 10)
    trail, growing = DrivenPath(), Layers()
    for step in range(200):
        trail.add(1.5 + math.cos(step / 20), math.sin(step / 20) + (2.0 if step == 120 else 0.0))
        together = growing.canvas(view, None, trail).lines()
    assert together == Layers().canvas(view, None, trail).lines()
    assert len(trail.pieces) == 3


# ---------------------------------------------------------------- the path


def test_a_path_is_thinned_torn_and_bounded() -> None:
    trail = DrivenPath()
    trail.add(0.0, 0.0)
    assert not trail.add(LEAST_M / 2, 0.0)
    for step in range(1, 5 * MOST):
        trail.add(step * 0.03, 0.0)
    assert sum(map(len, trail.pieces)) <= MOST
    assert trail.length_m == pytest.approx(5 * MOST * 0.03, rel=0.01)
    assert trail.revision > 0
    trail.add(0.0, 50.0)
    assert len(trail.pieces) == 2
    assert trail.bounds == [(0.0, 0.0), (pytest.approx(5 * MOST * 0.03, abs=0.5), 50.0)]
    for _jump in range(3 * MOST):
        trail.add(0.0, 0.0)
        trail.add(9.0, 0.0)
    assert sum(map(len, trail.pieces)) <= MOST
    trail.clear()
    assert (trail.pieces, trail.length_m, trail.bounds) == ([], 0.0, [])


# ---------------------------------------------------------------- what is read


def test_odometry_and_poses_are_read_and_an_empty_frame_is_no_goal() -> None:
    pose = {**NEST, "position": {"x": 1.0, "y": -2.0, "z": 0.0}}
    header = {"frame_id": "odom"}
    assert pose_in({"header": header, "pose": {"pose": pose, "covariance": []}}) == (
        Pose(1.0, -2.0, 0.0),
        "odom",
    )
    assert goal_in({"header": header, "pose": pose}) == Point(1.0, -2.0)
    assert goal_in({"header": {"frame_id": ""}, "pose": pose}) is None


@pytest.mark.parametrize(
    "value",
    [
        {},
        {"pose": 3},
        {"header": {"frame_id": "odom"}, "pose": {**NEST, "position": {"x": math.nan, "y": 0}}},
        {"header": {"frame_id": "odom"}, "pose": {**NEST, "position": {"x": 1e300, "y": 0}}},
        {"header": {"frame_id": "odom"}, "pose": {**NEST, "orientation": dict.fromkeys("xyzw", 0)}},
    ],
)
def test_what_is_no_place_is_none(value: dict[str, Any]) -> None:
    assert pose_in(value) is None
    assert goal_in(value) is None


@pytest.mark.parametrize(
    "more",
    [{"resolution": 0.0}, {"resolution": math.nan}, {"width": 3}, {"height": -1}, {"origin": {}}],
)
def test_a_map_that_makes_no_sense_is_none(more: dict[str, Any]) -> None:
    assert occupancy_in(grid_message(**more)) is None
    assert occupancy_in({}) is None
    assert isinstance(occupancy_in(grid_message()), OccupancyGrid)


def test_a_huge_map_is_looked_at_coarsely_and_one_of_nothing_has_no_extent() -> None:
    cells = np.full(3000 * 3000, -1, dtype=np.int8)
    info = {"height": 3000, "width": 3000, "resolution": 0.1, "origin": NEST}
    occupancy = occupancy_in({"header": {"frame_id": "map"}, "info": info, "data": cells})
    assert occupancy is not None
    assert occupancy.extent is None
    assert occupancy.cell_m == pytest.approx(0.2)
    assert occupancy.cells.size <= 4_000_000


# ---------------------------------------------------------------- the legend


@pytest.mark.parametrize(("width", "height"), [(60, 1), (40, 2), (30, 3), (28, 12), (10, 1)])
def test_the_legend_keeps_to_its_room_and_to_what_matters_most(width: int, height: int) -> None:
    view = fitted(ROOM, 40, 12)
    scene = Scene(
        Pose(1.234, -0.5, 0.5), Pose(1.0, 0, 0), Point(2.0, 0.0), {FRONT: 0.4, REAR: math.inf}
    )
    said = entries(scene, view, 3.21, ["no data for 5 s"])
    for lines in (rows(said, width, height), column(said, width, height)):
        assert len(lines) <= height
        assert all(cells_of(line) <= width for line in lines)
    text = "".join(ink.text for line in rows(said, width, height) for ink in line)
    assert "no data"[: width - 1] in text
    if width * height >= 60:
        assert "x 1.23  y -0.50 m" in text
    everything = "\n".join("".join(i.text for i in line) for line in column(said, 40, 20))
    for words in ("heading 29°", "path 3.2 m", "goal 0.9 m away", "front 0.4 m", "├", "y ↑ up"):
        assert words in everything
    assert "rear nothing in range" in everything
