"""The map, its pure half: where places of the floor are on the canvas, and what is said of them."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.motion.odometry import Pose
from tui.panels.map_scene import FRONT, REAR, Extent, Scene, Viewport, draw_scene, fitted
from tui.widgets.canvas import Canvas
from tui.widgets.drawing import Line

ROOM = Extent(-1.0, 4.0, -2.0, 2.0)
finite = st.floats(-50.0, 50.0)


def signs(lines: list[Line], char: str) -> list[tuple[int, int]]:
    """Column and row of each cell with this character."""
    texts = ["".join(ink.text for ink in line) for line in lines]
    return [(x, y) for y, text in enumerate(texts) for x, one in enumerate(text) if one == char]


def drawn(scene: Scene, view: Viewport) -> list[Line]:
    canvas = Canvas(view.columns, view.rows)
    draw_scene(canvas, view, scene)
    return canvas.lines()


# ---------------------------------------------------------------- the field


@given(finite, finite, st.floats(0.1, 80), st.floats(0.1, 80), st.integers(2, 200), st.integers(1, 60))
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
    assert right[0] - origin[0] == pytest.approx(origin[1] - up[1]) == pytest.approx(view.dots_per_m)
    assert right[1] == origin[1]
    assert up[0] == origin[0]


# ---------------------------------------------------------------- what is drawn


@pytest.mark.parametrize("heading", [0.0, 0.7, math.pi / 2, -2.4, math.pi])
@pytest.mark.parametrize(("place", "offset", "turn"), [(FRONT, 0.3, 0.0), (REAR, 0.05, math.pi)])
def test_a_ray_ends_where_the_sonar_found_something(heading: float, place: str, offset: float, turn: float) -> None:
    view = fitted(Extent(-3, 3, -3, 3), 80, 40)
    lines = drawn(Scene(Pose(0.2, -0.1, heading), rays={place: 1.5}), view)
    x = 0.2 + (1.5 + offset) * math.cos(heading + turn)
    y = -0.1 + (1.5 + offset) * math.sin(heading + turn)
    end = view.place(x, y)
    assert signs(lines, "●") == [(int(end[0]) // 2, int(end[1]) // 4)]
