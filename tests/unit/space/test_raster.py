"""From a place to a dot of the terminal: the camera, what hides what, names, thinned clouds."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from space.drawing.camera import Angle, SpaceCamera
from space.drawing.paints import Tint
from space.drawing.raster import CellPicture, Raster
from space.drawing.scene import draw
from space.drawing.shapes import Floor, places
from space.drawing.sign_rows import SignRows
from space.transform import Transform

WIDTH, HEIGHT = 160, 120


def spot(camera: SpaceCamera, *point: float) -> tuple[float, float, float]:
    x, y, depth = camera.project(places((point[0], point[1], point[2])), WIDTH, HEIGHT)[0].tolist()
    return x, y, depth


def test_from_above_x_goes_to_the_right_and_y_upwards() -> None:
    camera = SpaceCamera(Angle.ABOVE, (1.0, 2.0, 0.0), 10.0)
    assert spot(camera, 1.0, 2.0, 0.0)[:2] == pytest.approx((80, 60))
    assert spot(camera, 3.0, 2.0, 0.0)[:2] == pytest.approx((100, 60))
    assert spot(camera, 1.0, 3.0, 5.0)[:2] == pytest.approx((80, 50))


def test_from_the_side_z_goes_upwards_and_a_small_y_is_near() -> None:
    camera = SpaceCamera(Angle.SIDE, (0.0, 0.0, 0.0), 10.0)
    assert spot(camera, 1.0, 7.0, 2.0)[:2] == pytest.approx((90, 40))
    assert spot(camera, 0.0, -1.0, 0.0)[2] < spot(camera, 0.0, 1.0, 0.0)[2]


def spots(*rows: tuple[float, float, float]) -> np.ndarray[tuple[int, int], np.dtype[np.float32]]:
    """Places in the picture: x, y, depth."""
    return np.array(rows, dtype=np.float32)


def lines(picture: CellPicture) -> list[str]:
    return ["".join(map(chr, row)) for row in picture.codes.tolist()]


def test_a_dot_is_where_braille_has_it() -> None:
    raster = Raster(2, 1)
    raster.dots(spots((0, 0, 1), (3, 3, 1)), Tint.TEXT)
    assert lines(raster.cells()) == ["⠁⢀"]


def test_the_nearer_dot_gives_the_paint_in_whatever_order() -> None:
    for order in (1, -1):
        raster = Raster(1, 1)
        for depth, paint in ((5.0, Tint.GOOD), (2.0, Tint.BAD))[::order]:
            raster.dots(spots((0, 0, depth)), paint)
        assert raster.cells().front[0, 0] == Tint.BAD


def test_a_face_covers_what_is_behind_it_and_not_what_is_before() -> None:
    raster = Raster(4, 2)
    raster.dots(spots((2, 2, 5)), Tint.BAD)
    raster.dots(spots((3, 2, 1)), Tint.GOOD)
    raster.faces(spots((0, 0, 3), (8, 0, 3), (0, 8, 3))[None], Tint.TEXT)
    raster.faces(spots((0, 0, 3), (0, 0, 3), (0, 0, 3))[None], Tint.WARN)
    raster.faces(spots((0, 0, 3), (5, 0, math.nan), (0, 5, 3))[None], Tint.WARN)
    picture = raster.cells()
    assert picture.back[0, 1] == Tint.GOOD
    assert {*picture.front.ravel().tolist()} == {Tint.NOTHING, Tint.TEXT}


def test_signs_do_not_overlap() -> None:
    raster = Raster(12, 4)
    for text in ("base_link", "laser"):
        raster.sign(2, 5, text, Tint.TEXT)
    assert [line.strip() for line in lines(raster.cells())] == ["", "base_link", "laser", ""]


def test_a_floor_is_seen_where_it_is() -> None:
    cells = np.full((10, 10), Tint.FREE, dtype=np.uint8)
    cells[:, 5] = Tint.WALL
    raster = Raster(10, 5)
    floor = Floor(cells, 1.0, Transform((-5.0, -5.0, 0.0)))
    draw(raster, SpaceCamera(Angle.ABOVE, dots_per_m=2.0), [floor])
    picture = raster.cells()
    assert picture.back[2].tolist() == [Tint.FREE] * 5 + [Tint.WALL] + [Tint.FREE] * 4


def rows_of(*signs: tuple[str, int, int], before: dict[str, int | None] | None = None) -> dict[str, int | None]:
    """By how many rows texts move, each given with its row and column; none is over another."""
    rows = SignRows(10, before or {})
    for text, row, column in signs:
        rows.write(row, column, text, 1, text)
    for one, other in itertools.permutations(rows.written, 2):
        first, then = sorted((one, other), key=lambda sign: sign.column)
        assert one.row != other.row or first.column + len(first.text) < then.column
    return rows.moved


def test_a_name_moves_only_where_it_must_and_returns_only_where_there_is_room() -> None:
    crowd = rows_of(*((f"frame_{number}", 4, 10) for number in range(7)))
    assert list(crowd.values()) == [0, 1, -1, 2, -2, None, None]
    for column, before, away in ((20, None, 1), (29, 1, 1), (30, 1, 0), (27, 0, 0)):
        known: dict[str, int | None] = {} if before is None else {"arm": before}
        moved = rows_of(("front_left_wheel", 4, 10), ("arm", 4, column), before=known)
        assert moved["arm"] == away, (column, before)
