"""From a place to a dot of the terminal: the camera, what covers what, names."""

from __future__ import annotations

import numpy as np
import pytest

from space.drawing.paints import Tint
from space.drawing.picture import CellPicture, SpaceBox, SpaceCamera, extent_of, picture
from space.drawing.shapes import Floor, Shape, Sign, Speckles, Strokes, box, places
from space.placing import frame_shapes
from space.transform import Transform

ONE = SpaceCamera(dots_per_m=1.0)
"""A metre is a dot, and the place 0, 0 is in the middle."""


def lines(columns: int, rows: int, *shapes: Shape) -> list[str]:
    return ["".join(map(chr, row)) for row in drawn(columns, rows, *shapes).codes.tolist()]


def drawn(columns: int, rows: int, *shapes: Shape) -> CellPicture:
    return picture(ONE, shapes, columns, rows)


def test_x_goes_to_the_right_and_y_upwards() -> None:
    camera = SpaceCamera(1.0, 2.0, 10.0)
    spots = camera.spots(places((1, 2, 0), (3, 2, 0), (1, 3, 5)), 160, 120)
    assert spots.tolist() == [[80, 60], [100, 60], [80, 50]]
    assert camera.floor_at(100, 50, 160, 120) == (3.0, 3.0)
    closer = camera.zoomed(2.0, 20, -10)
    assert closer.floor_at(100, 50, 160, 120) == pytest.approx((3.0, 3.0)), "what the mouse is at stays there"


def test_a_box_that_is_fitted_is_seen_whole() -> None:
    corners = places((-3, 1, 0), (7, 2, 9))
    found = extent_of([Speckles(corners), Strokes(corners * 9, corners * 9, Tint.MUTED)])
    assert found == SpaceBox(-3, 1, 7, 2), "what is muted shows where nothing is"
    spots = ONE.fitting(found, 100, 80).spots(corners, 100, 80)
    assert spots[:, 0].tolist() == pytest.approx([2, 98])


def test_a_dot_is_where_braille_has_it() -> None:
    assert lines(2, 1, Speckles(places((-2, 2, 0), (1, -1, 0)))) == ["⠁⢀"]


def test_a_line_is_cut_at_the_edge() -> None:
    assert lines(2, 1, Strokes(places((-9e5, 0.5, 0)), places((9e5, 0.5, 0)))) == ["⠒⠒"]


def test_a_box_is_its_outline() -> None:
    (shape,) = box(Transform((0.5, 0.5, 0.0)), (2.0, 2.0, 1.0), Tint.GOOD)
    assert lines(2, 1, shape) == ["⠸⠽"]
    assert drawn(2, 1, shape).front.tolist() == [[Tint.GOOD, Tint.GOOD]]


def test_a_floor_is_seen_where_it_is() -> None:
    cells = np.full((10, 10), Tint.FREE, dtype=np.uint8)
    cells[:, 5] = Tint.WALL
    shown = picture(SpaceCamera(dots_per_m=2.0), [Floor(cells, 1.0, Transform((-5.0, -5.0, 0.0)))], 10, 5)
    assert shown.front[2].tolist() == [0] * 5 + [Tint.WALL] + [0] * 4
    assert shown.back[2].tolist() == [Tint.FREE] * 5 + [0] + [Tint.FREE] * 4


def test_a_wall_thinner_than_a_dot_is_not_missed() -> None:
    cells = np.full((300, 300), Tint.FREE, dtype=np.uint8)
    cells[150, 150] = Tint.WALL
    shown = picture(ONE, [Floor(cells, 0.1, Transform((-15.0, -15.0, 0.0)))], 20, 10)
    assert Tint.WALL in shown.front


def test_signs_do_not_overlap() -> None:
    shapes = [Sign((-10.0, 3.0, 0.0), text) for text in ("base_link", "laser")]
    assert [line.strip() for line in lines(12, 4, *shapes)] == ["", "base_link", "laser", ""]


def test_a_sign_makes_way_for_what_is_drawn_at_its_place() -> None:
    robot, wall = (Strokes(places((-20, 0.5, 0)), places((end, 0.5, 0))) for end in (-13, 30))
    sign = Sign((-20.0, 0.5, 0.0), "base")
    assert lines(20, 1, robot, sign) == ["⠒⠒⠒⠒base            "]
    assert lines(20, 1, wall, sign)[0][1:5] == "base"


def test_frames_in_one_place_share_a_line_for_their_names() -> None:
    frames = {name: Transform() for name in ("a", "b", "c")} | {"far": Transform((9.0, 0.0, 0.0))}
    assert [one.text for one in frame_shapes(frames, 40.0, ("b",)) if isinstance(one, Sign)] == ["b +2", "far"]
