"""The picture of the simulated room: what stands where, from everywhere, with the head turned."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot.motion.odometry import Pose
from robot.world.room import LIVING_ROOM, Box, Room
from robot.world.view import FIELD_RAD, HEIGHT_M, CameraPose, RoomView
from tests.unit.free_floor import on_free_floor

if TYPE_CHECKING:
    from numpy.typing import NDArray

HEIGHT, WIDTH = 96, 128
EYES = st.builds(
    CameraPose,
    st.floats(-3, 6),
    st.floats(-4, 4),
    st.floats(0, 2.5),
    st.floats(-10, 10),
    st.floats(-math.pi / 2, math.pi / 2),
)


def draw(view: RoomView, eye: CameraPose) -> NDArray[np.uint8]:
    picture = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    view.draw(picture, eye)
    return picture


@pytest.fixture(scope="module")
def view() -> RoomView:
    return RoomView(LIVING_ROOM, HEIGHT, WIDTH, blue_first=False)


@pytest.mark.parametrize(
    ("pan_deg", "leads"), [(90, "green"), (-90, "red"), (180, "blue"), (-180, "blue")]
)
def test_each_wall_has_a_colour_of_its_own(view: RoomView, pan_deg: float, leads: str) -> None:
    picture = draw(view, CameraPose.on(Pose(1.35, 0.0), math.radians(pan_deg)))
    parts = dict(zip(("red", "green", "blue"), picture[30:46, 5:30].mean(axis=(0, 1)), strict=True))
    assert max(parts, key=lambda part: parts[part]) == leads


def test_up_is_the_ceiling_and_down_is_the_floor(view: RoomView) -> None:
    up, down = (draw(view, CameraPose.on(Pose(), 0.0, tilt)) for tilt in (1.5, -1.5))
    assert np.ptp(up.astype(int), axis=2).max() < 40
    assert up.mean() > down.mean() + 50


def test_the_window_is_ahead_and_the_sky_above_the_grass(view: RoomView) -> None:
    picture = draw(view, CameraPose.on(Pose(1.0, 0.0)))
    column = picture[: HEIGHT // 2, WIDTH // 2 - 12].astype(int)
    sky = np.flatnonzero(column[:, 2] > column[:, 0] + 60)
    grass = np.flatnonzero((column[:, 1] > column[:, 0] + 20) & (column[:, 1] > column[:, 2] + 20))
    assert len(sky)
    assert len(grass)
    assert sky.max() < grass.min()


def test_blue_may_come_first() -> None:
    eye = CameraPose.on(Pose(0.3, -0.4, 0.2))
    blue, red = (
        draw(RoomView(LIVING_ROOM, HEIGHT, WIDTH, blue_first=b), eye) for b in (True, False)
    )
    assert (blue == red[:, :, ::-1]).all()
    assert (blue != red).any()


@settings(max_examples=15)
@given(st.floats(-0.9, 3.9), st.floats(-1.9, 1.9), st.floats(-math.pi, math.pi))
def test_a_box_is_seen_where_a_ray_of_the_sonars_meets_it(
    x: float, y: float, heading: float
) -> None:
    walls, box = LIVING_ROOM.walls, LIVING_ROOM.boxes[0]
    with_box, without = Room(walls, (box,)), Room(walls)
    if with_box.clearance(x, y) < 0.1 or not on_free_floor(with_box, x, y):
        return
    eye = CameraPose(x, y, HEIGHT_M, heading)
    pictures = [draw(RoomView(room, HEIGHT, WIDTH), eye) for room in (with_box, without)]
    row = HEIGHT // 2 - 1
    seen = (pictures[0][row] != pictures[1][row]).any(axis=1)
    met = []
    for column in np.linspace(1, -1, WIDTH // 2):
        ray = heading + math.atan(math.tan(FIELD_RAD / 2) * column)
        met.append(with_box.distance(x, y, ray) < without.distance(x, y, ray) - 1e-6)
    assert np.count_nonzero(seen[::2] != met) <= 2


def test_a_nearer_box_hides_a_farther_one() -> None:
    near, far = Box(1.5, 0, 0.4, 1.0), Box(2.5, 0, 0.4, 0.6)
    rooms = Room(LIVING_ROOM.walls, (near, far)), Room(LIVING_ROOM.walls, (near,))
    pictures = [
        draw(RoomView(room, HEIGHT, WIDTH), CameraPose(0.5, 0, HEIGHT_M, 0)) for room in rooms
    ]
    # The farther one is taller, and looks out above.
    assert (pictures[0] != pictures[1])[: HEIGHT // 2 - 12].any()
    assert (pictures[0] == pictures[1])[HEIGHT // 2 - 2 :].all()


@settings(max_examples=15)
@given(EYES)
def test_a_box_is_nowhere_but_in_the_part_that_it_is_looked_for_in(eye: CameraPose) -> None:
    view = RoomView(LIVING_ROOM, HEIGHT, WIDTH)
    picture = draw(view, eye)
    everywhere = slice(0, HEIGHT // 2), slice(0, WIDTH // 2)
    view._part_with = lambda *_: everywhere  # type: ignore[method-assign]
    assert (draw(view, eye) == picture).all()


@pytest.mark.parametrize(
    "eye",
    [
        CameraPose(4.0, 2.0, 0.0, 0.0),
        CameraPose(-1.0, 0.0, 2.5, math.pi, math.pi / 2),
        CameraPose(2.2, 0.2, 0.1, 0.0),
        CameraPose(100.0, -100.0, 50.0, 1.0),
    ],
)
def test_an_eye_where_none_can_be_sees_something(view: RoomView, eye: CameraPose) -> None:
    assert draw(view, eye).any()


@pytest.mark.parametrize(("height", "width"), [(17, 31), (480, 640), (16, 16)])
def test_a_picture_of_any_size_is_filled(height: int, width: int) -> None:
    picture = np.zeros((height, width, 3), np.uint8)
    RoomView(Room(Box(0, 0, 1, 1)), height, width).draw(picture, CameraPose(0, 0, 0.2, 0.3))
    assert picture.any(axis=2).all()
