"""Dots and cells: what is nearer covers what is farther, and nothing breaks at the edge."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from space.drawing.braille import BLANK, BRAILLE
from space.drawing.camera import Angle, SpaceCamera
from space.drawing.paints import (
    CUBE_FROM,
    RAMP_FROM,
    RAMP_STEPS,
    Tint,
    cube,
    nearest,
    ramp,
    rgb_of,
)
from space.drawing.raster import FULL_BLOCK, CellPicture, Raster
from space.drawing.scene import draw
from space.drawing.shapes import Faces, Floor, Shape, Sign, Speckles, Strokes, box, places
from space.transform import IDENTITY, Transform

ONE_DOT = 0x2801


def spots(*rows: tuple[float, float, float]) -> np.ndarray[tuple[int, int], np.dtype[np.float32]]:
    """Places in the picture: x, y, depth."""
    return np.array(rows, dtype=np.float32)


def lines(picture: CellPicture) -> list[str]:
    """The characters, row by row."""
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


def test_of_many_dots_at_once_the_nearest_is_on_top() -> None:
    raster = Raster(1, 1)
    paints = np.array([Tint.GOOD, Tint.BAD, Tint.WARN], dtype=np.uint8)
    raster.dots(spots((0, 0, 3), (0, 0, 1), (0, 0, 2)), paints)
    raster.dots(spots((0, 0, 3), (0, 0, 5), (0, 0, 2)), paints)
    assert raster.cells().front[0, 0] == Tint.BAD


def test_dots_outside_and_nan_are_ignored() -> None:
    raster = Raster(1, 1)
    outside = spots((-1, 0, 1), (2, 0, 1), (0, 4, 1), (math.nan, 0, 1), (0, math.nan, 1))
    raster.dots(outside, Tint.TEXT)
    assert lines(raster.cells()) == [" "]


def test_a_stroke_reaches_from_end_to_end() -> None:
    raster = Raster(5, 1)
    raster.strokes(spots((0, 1, 1)), spots((9, 1, 1)), Tint.TEXT)
    assert lines(raster.cells()) == ["⠒⠒⠒⠒⠒"]


@given(
    arrays(np.float32, (6, 3), elements=st.floats(-1e6, 1e6, width=32)),
    arrays(np.float32, (6, 3), elements=st.floats(-1e6, 1e6, width=32)),
)
def test_strokes_of_any_length_stay_inside(
    starts: np.ndarray[tuple[int, int], np.dtype[np.float32]],
    ends: np.ndarray[tuple[int, int], np.dtype[np.float32]],
) -> None:
    raster = Raster(7, 3)
    raster.strokes(starts, ends, Tint.TEXT)
    assert raster.cells().codes.shape == (3, 7)


def test_a_whole_cell_has_two_halves_of_their_own_colours() -> None:
    raster = Raster(1, 1)
    upper = spots(*[(x, y, 1) for x in (0, 1) for y in (0, 1)])
    lower = spots(*[(x, y, 1) for x in (0, 1) for y in (2, 3)])
    raster.dots(upper, Tint.GOOD)
    raster.dots(lower, Tint.BAD)
    picture = raster.cells()
    assert (lines(picture), picture.front[0, 0], picture.back[0, 0]) == (
        ["▀"],
        Tint.GOOD,
        Tint.BAD,
    )


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


@pytest.mark.parametrize("size", [1.5, 4.0, 11.0, 30.0])
def test_small_and_large_faces_are_filled_without_gaps(size: float) -> None:
    raster = Raster(20, 10)
    raster.faces(spots((1, 1, 1), (1 + size, 1, 1), (1, 1 + size, 1))[None], Tint.GOOD)
    codes = raster.cells().codes.ravel().tolist()
    dots = sum(
        8 if code == FULL_BLOCK else (code - BRAILLE).bit_count() for code in codes if code != BLANK
    )
    assert dots == pytest.approx(size * size / 2, abs=2 * size + 3)


def test_a_box_is_seen_from_three_sides_the_upper_one_brightest() -> None:
    raster = Raster(30, 15)
    camera = SpaceCamera(Angle.PERSPECTIVE, dots_per_m=20.0)
    draw(raster, camera, box(IDENTITY, (1.0, 1.0, 1.0), nearest(1.0, 1.0, 1.0)))
    picture = raster.cells()
    sides = {*picture.front.ravel().tolist(), *picture.back.ravel().tolist()} - {Tint.NOTHING}
    assert len(sides) == 3
    assert max(sides) == picture.front[picture.codes > BLANK][0]


def test_signs_do_not_overlap() -> None:
    raster = Raster(12, 4)
    for text in ("base_link", "laser"):
        raster.sign(2, 5, text, Tint.TEXT)
    assert [line.strip() for line in lines(raster.cells())] == ["", "base_link", "laser", ""]


def test_a_sign_is_cut_at_the_edge() -> None:
    raster = Raster(5, 1)
    raster.sign(6, 0, "base_link", Tint.TEXT)
    assert lines(raster.cells()) == ["   ba"]


def test_a_floor_is_seen_where_it_is() -> None:
    cells = np.full((10, 10), Tint.FREE, dtype=np.uint8)
    cells[:, 5] = Tint.WALL
    raster = Raster(10, 5)
    floor = Floor(cells, 1.0, Transform((-5.0, -5.0, 0.0)))
    draw(raster, SpaceCamera(Angle.ABOVE, dots_per_m=2.0), [floor])
    picture = raster.cells()
    assert picture.back[2].tolist() == [Tint.FREE] * 5 + [Tint.WALL] + [Tint.FREE] * 4


def test_a_wall_thinner_than_a_dot_is_not_lost() -> None:
    cells = np.full((400, 400), Tint.FREE, dtype=np.uint8)
    cells[:, 200] = Tint.WALL
    raster = Raster(10, 5)
    floor = Floor(cells, 0.05, Transform((-10.0, -10.0, 0.0)))
    draw(raster, SpaceCamera(Angle.ABOVE, dots_per_m=0.5), [floor])
    assert (raster.cells().front == Tint.WALL).any()


def test_a_line_that_begins_behind_the_eye_is_seen_from_where_it_comes_into_sight() -> None:
    raster = Raster(10, 5)
    camera = SpaceCamera(Angle.PERSPECTIVE, dots_per_m=20.0, yaw_rad=0.0, pitch_rad=0.5)
    line = Strokes(places((-50.0, 0.0, 0.0)), places((3.0, 0.0, 0.0)), Tint.BAD)
    draw(raster, camera, [line])
    assert (raster.cells().front == Tint.BAD).any()


@given(st.sampled_from(list(Angle)), st.floats(0.01, 1e4))
def test_anything_may_be_empty(angle: Angle, scale: float) -> None:
    raster = Raster(4, 2)
    nothing = np.zeros((0, 3), dtype=np.float32)
    shapes: list[Shape] = [
        Speckles(nothing),
        Strokes(nothing, nothing),
        Faces(np.zeros((0, 3, 3), dtype=np.float32)),
        Sign((0.0, 0.0, 0.0), ""),
        Floor(np.zeros((1, 1), dtype=np.uint8), 1.0),
    ]
    draw(raster, SpaceCamera(angle, dots_per_m=scale), shapes)
    assert lines(raster.cells()) == ["    "] * 2


def test_only_changed_cells_differ() -> None:
    raster, other = Raster(3, 1), Raster(3, 1)
    other.dots(spots((4, 0, 1)), Tint.TEXT)
    assert other.cells().changed(raster.cells()).tolist() == [[False, False, True]]


def test_a_step_of_the_ramp_does_not_flicker_and_two_do() -> None:
    pictures = []
    for paint in (RAMP_FROM + 3, RAMP_FROM + 4, RAMP_FROM + 6):
        raster = Raster(1, 1)
        raster.dots(spots((0, 0, 1)), paint)
        pictures.append(raster.cells())
    first, near, far = pictures
    assert not near.steadied(first).changed(first).any()
    assert far.steadied(first).changed(first).all()


def test_the_ramp_goes_from_the_least_to_the_most() -> None:
    values = np.array([-5.0, 0.0, 10.0, 99.0])
    assert ramp(values, 0.0, 10.0).tolist() == [
        RAMP_FROM,
        RAMP_FROM,
        RAMP_FROM + RAMP_STEPS - 1,
        RAMP_FROM + RAMP_STEPS - 1,
    ]


def test_every_paint_has_a_colour_or_a_name() -> None:
    assert cube(np.array([[255, 0, 0]], dtype=np.uint8))[0] == nearest(1.0, 0.0, 0.0)
    assert rgb_of(nearest(1.0, 0.0, 0.0)) == (255, 0, 0)
    for paint in (*Tint, *range(RAMP_FROM, RAMP_FROM + RAMP_STEPS), CUBE_FROM, CUBE_FROM + 215):
        rgb = rgb_of(paint)
        assert rgb is None or all(0 <= channel <= 255 for channel in rgb)
    assert rgb_of(nearest(math.nan, 5.0, -1.0)) == (0, 255, 0)


def cell_of(*dots: tuple[int, int]) -> CellPicture:
    """One cell with these dots."""
    raster = Raster(1, 1)
    raster.dots(spots(*[(x, y, 1) for x, y in dots]), Tint.TEXT)
    return raster.cells()


DENSE = ((0, 0), (1, 0), (0, 1), (1, 1), (0, 2))


def test_one_dot_of_noise_is_not_seen_in_a_surface_but_in_a_line() -> None:
    before, noisy = cell_of(*DENSE), cell_of(*DENSE, (1, 2))
    assert not noisy.steadied(before).changed(before).any()
    moved = cell_of(*DENSE[:-2], (0, 3), (1, 3))
    assert moved.steadied(before).changed(before).all()
    thin, thinner = cell_of(*DENSE[:2]), cell_of(*DENSE[:1])
    assert thinner.steadied(thin).changed(thin).all()


def test_a_block_stays_one_while_a_dot_or_two_are_missing() -> None:
    every = [(x, y) for x in (0, 1) for y in range(4)]
    block = cell_of(*every)
    assert not cell_of(*every[:-1]).steadied(block).changed(block).any()
    assert cell_of(*every[:-3]).steadied(block).changed(block).all()
