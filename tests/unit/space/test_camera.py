"""Where the camera shows points, and how mouse and keys move it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from space.drawing.camera import Angle, SpaceCamera
from space.drawing.shapes import places
from space.transform import Vector

WIDTH, HEIGHT = 160, 120
NEAR = st.floats(-20, 20, width=32)
SPOTS = st.tuples(st.floats(1, WIDTH - 1), st.floats(1, HEIGHT - 1))


def spot(camera: SpaceCamera, *point: float) -> tuple[float, float, float]:
    """Where one point is shown."""
    x, y, depth = camera.project(places((point[0], point[1], point[2])), WIDTH, HEIGHT)[0].tolist()
    return x, y, depth


def test_from_above_x_goes_to_the_right_and_y_upwards() -> None:
    camera = SpaceCamera(Angle.ABOVE, (1.0, 2.0, 0.0), 10.0)
    assert spot(camera, 1.0, 2.0, 0.0)[:2] == pytest.approx((80, 60))
    assert spot(camera, 3.0, 2.0, 0.0)[:2] == pytest.approx((100, 60))
    assert spot(camera, 1.0, 3.0, 5.0)[:2] == pytest.approx((80, 50))


def test_from_above_what_is_higher_is_nearer() -> None:
    camera = SpaceCamera(Angle.ABOVE)
    assert spot(camera, 0.0, 0.0, 1.0)[2] < spot(camera, 0.0, 0.0, 0.0)[2]


def test_from_the_side_z_goes_upwards_and_a_small_y_is_near() -> None:
    camera = SpaceCamera(Angle.SIDE, (0.0, 0.0, 0.0), 10.0)
    assert spot(camera, 1.0, 7.0, 2.0)[:2] == pytest.approx((90, 40))
    assert spot(camera, 0.0, -1.0, 0.0)[2] < spot(camera, 0.0, 1.0, 0.0)[2]


def test_in_perspective_half_the_distance_is_twice_the_size() -> None:
    camera = SpaceCamera(Angle.PERSPECTIVE, (0.0, 0.0, 0.0), 10.0, yaw_rad=0.0, pitch_rad=0.0)
    away = camera.distance_m(HEIGHT)
    assert spot(camera, 0.0, -1.0, 0.0)[:2] == pytest.approx((90, 60), abs=1e-3)
    assert spot(camera, -away / 2, -1.0, 0.0)[:2] == pytest.approx((100, 60), abs=1e-3)
    assert spot(camera, 0.0, 0.0, 0.0)[2] == pytest.approx(away)


def test_what_is_behind_the_eye_is_not_shown() -> None:
    camera = SpaceCamera(Angle.PERSPECTIVE, dots_per_m=100.0, yaw_rad=0.0, pitch_rad=0.0)
    assert math.isnan(spot(camera, -100.0, 0.0, 0.0)[0])


def test_the_perspective_of_a_quarter_turn_down_is_the_view_from_above() -> None:
    turned = SpaceCamera(Angle.PERSPECTIVE, yaw_rad=math.pi / 2, pitch_rad=math.pi / 2)
    assert turned.basis() == pytest.approx(SpaceCamera(Angle.ABOVE).basis())


@given(yaw=st.floats(-4, 4), pitch=st.floats(-1.5, 1.5))
def test_the_axes_of_the_picture_are_perpendicular(yaw: float, pitch: float) -> None:
    basis = SpaceCamera(Angle.PERSPECTIVE, yaw_rad=yaw, pitch_rad=pitch).basis()
    assert basis @ basis.T == pytest.approx(np.eye(3), abs=1e-9)


@pytest.mark.parametrize("angle", [Angle.ABOVE, Angle.PERSPECTIVE])
@given(place=st.tuples(NEAR, NEAR), scale=st.floats(2, 80))
def test_the_place_below_a_dot_is_shown_at_that_dot(
    angle: Angle, place: tuple[float, float], scale: float
) -> None:
    camera = SpaceCamera(angle, (place[0] + 0.5, place[1], 0.0), scale)
    x, y, _depth = spot(camera, *place, 0.0)
    if math.isnan(x):
        return
    assert camera.floor_at(x, y, WIDTH, HEIGHT) == pytest.approx(place, abs=0.05)


def test_there_is_no_floor_in_the_sky() -> None:
    camera = SpaceCamera(Angle.PERSPECTIVE, pitch_rad=0.1)
    assert camera.floor_at(80, 1, WIDTH, HEIGHT) is None
    assert SpaceCamera(Angle.SIDE).floor_at(80, 1, WIDTH, HEIGHT) is None


@pytest.mark.parametrize("angle", list(Angle))
@given(at=SPOTS, factor=st.floats(0.2, 5))
def test_zooming_keeps_what_is_under_the_pointer(
    angle: Angle, at: tuple[float, float], factor: float
) -> None:
    if angle is Angle.PERSPECTIVE:
        # Exactly only in the middle, where all of perspective is to scale.
        at = (WIDTH / 2, HEIGHT / 2)
    camera = SpaceCamera(angle, (1.0, 2.0, 0.5), 20.0)
    begins, _ways = camera.rays(np.array([at[0]]), np.array([at[1]]), WIDTH, HEIGHT)
    place = begins[0].tolist() if angle is not Angle.PERSPECTIVE else camera.target
    closer = camera.zoomed(factor, at[0] - WIDTH / 2, at[1] - HEIGHT / 2)
    assert spot(closer, *place)[:2] == pytest.approx(at, abs=0.05)
    assert closer.dots_per_m == pytest.approx(20.0 * factor)


def test_no_zoom_is_too_near_or_too_far() -> None:
    camera = SpaceCamera()
    for _step in range(200):
        camera = camera.zoomed(1.5)
    assert math.isfinite(camera.zoomed(1.5).dots_per_m)
    for _step in range(400):
        camera = camera.zoomed(0.5)
    assert camera.dots_per_m > 0


@pytest.mark.parametrize("angle", [Angle.ABOVE, Angle.SIDE])
def test_a_drag_moves_the_picture_with_the_mouse(angle: Angle) -> None:
    camera = SpaceCamera(angle, (1.0, 2.0, 0.5), 20.0)
    before = spot(camera, 1.0, 2.0, 0.5)
    after = spot(camera.panned(10.0, 6.0), 1.0, 2.0, 0.5)
    assert (after[0] - before[0], after[1] - before[1]) == pytest.approx((10, 6), abs=1e-3)


def test_only_the_perspective_turns_and_never_over_the_top() -> None:
    assert SpaceCamera(Angle.ABOVE).turned(1.0, 1.0) == SpaceCamera(Angle.ABOVE)
    camera = SpaceCamera(Angle.PERSPECTIVE).turned(0.5, 9.0)
    assert camera.pitch_rad == pytest.approx(math.pi / 2)
    assert camera.yaw_rad == pytest.approx(SpaceCamera().yaw_rad + 0.5)


@pytest.mark.parametrize("angle", list(Angle))
@given(
    least=st.tuples(NEAR, NEAR, NEAR),
    size=st.tuples(st.floats(0.1, 30), st.floats(0.1, 30), st.floats(0.1, 3)),
)
def test_fitting_shows_all_of_a_box_and_no_less(angle: Angle, least: Vector, size: Vector) -> None:
    most = (least[0] + size[0], least[1] + size[1], least[2] + size[2])
    camera = SpaceCamera(angle).fitting(least, most, WIDTH, HEIGHT)
    sides = list(zip(least, most, strict=True))
    corners = places(*[(x, y, z) for x in sides[0] for y in sides[1] for z in sides[2]])
    spots = camera.project(corners, WIDTH, HEIGHT)
    assert (spots[:, 0] >= 0).all()
    assert (spots[:, 0] <= WIDTH).all()
    assert (spots[:, 1] >= 0).all()
    assert (spots[:, 1] <= HEIGHT).all()
    larger = replace(camera, dots_per_m=camera.dots_per_m * 1.1)
    grown = larger.project(corners, WIDTH, HEIGHT)
    beyond = (grown[:, :2] < 1).any() or (grown[:, 0] > WIDTH - 1).any()
    assert beyond or (grown[:, 1] > HEIGHT - 1).any() or np.isnan(grown).any()
