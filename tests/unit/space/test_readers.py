"""What messages show, and the sentence for each that shows nothing."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

from space.drawing.paints import RAMP_FROM, RAMP_STEPS, Tint
from space.drawing.shapes import Floor, Sign, Speckles, Strokes
from space.reading.clouds import read_cloud
from space.reading.fields import Drawable, NotDrawnError
from space.reading.grids import read_grid
from space.reading.poses import DrivenTrail, read_goal, read_path
from space.reading.robot import ModelReader
from space.reading.scans import read_range, read_scan, read_sonar
from space.transform import Transform
from tests.unit.space.trees import cloud_tree, header, pose_tree

Tree = dict[str, Any]
THREE = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]])


def grid(columns: int = 3, rows: int = 2, **more: Any) -> Tree:
    """A map with a free, an unknown, an occupied and three doubtful cells."""
    info = {"resolution": 0.5, "width": columns, "height": rows, "origin": pose_tree(Transform((1.0, 2.0, 0.0)))}
    data = np.array([0, -1, 100, 50, 50, 50], dtype=np.int8)
    return {"header": header("map"), "info": {**info, **more}, "data": data}


def scan(*ranges: float, **more: Any) -> Tree:
    """A scan that begins ahead, a quarter turn a ray."""
    tree = {
        "header": header("laser"),
        "angle_min": 0.0,
        "angle_increment": math.pi / 2,
        "range_min": 0.1,
        "range_max": 10.0,
        "ranges": np.array(ranges, dtype=np.float32),
    }
    return {**tree, **more}


def speckles(drawable: Drawable) -> Speckles:
    (shape,) = drawable.shapes
    assert isinstance(shape, Speckles)
    return shape


def test_a_map_is_a_floor_of_free_occupied_and_doubtful_cells() -> None:
    drawable = read_grid(grid())
    (floor,) = drawable.shapes
    assert isinstance(floor, Floor)
    assert floor.cells.tolist() == [[Tint.FREE, Tint.NOTHING, Tint.WALL], [Tint.MAYBE, Tint.MAYBE, Tint.MAYBE]]
    assert (floor.cell_m, floor.origin.translation) == (0.5, (1.0, 2.0, 0.0))
    assert drawable.frame == "map"


def test_a_scan_is_where_its_rays_end() -> None:
    places = speckles(read_scan(scan(1.0, 2.0, 3.0))).places
    assert places == pytest.approx(np.array([[1, 0, 0], [0, 2, 0], [-3, 0, 0]]), abs=1e-6)


def test_ranges_that_are_not_valid_are_left_out() -> None:
    found = read_scan(scan(math.nan, math.inf, 0.01, 20.0, 1.0))
    assert len(speckles(found).places) == 1
    assert found.remark is None
    nothing = read_scan(scan(math.nan, math.inf))
    assert nothing.remark == "no range is valid, of 2"


@pytest.mark.parametrize(("metres", "paint"), [(1.0, Tint.WARN), (math.inf, Tint.MUTED), (math.nan, Tint.MUTED)])
def test_a_bare_sonar_shows_what_rep_117_says(metres: float, paint: Tint) -> None:
    drawable = read_sonar({"data": metres}, "sonar_front_link")
    first = drawable.shapes[0]
    assert isinstance(first, Strokes)
    assert first.paint == paint
    assert drawable.frame == "sonar_front_link"
    assert any(isinstance(shape, Sign) for shape in drawable.shapes) == math.isnan(metres)


def test_a_cloud_is_its_points_coloured_by_height() -> None:
    shape = speckles(read_cloud(cloud_tree(THREE, "lidar")))
    assert shape.places.tolist() == THREE.tolist()
    assert isinstance(shape.paint, np.ndarray)
    assert shape.paint[0] == RAMP_FROM
    assert shape.paint[-1] == RAMP_FROM + RAMP_STEPS - 1


def odometry(x: float, frame: str = "odom") -> Tree:
    return {"header": header(frame), "pose": {"pose": pose_tree(Transform((x, 0.0, 0.0)))}}


def trail_of(drawable: Drawable) -> Strokes:
    dart, line = drawable.shapes
    assert isinstance(dart, Strokes)
    assert isinstance(line, Strokes)
    return line


def test_odometry_leaves_a_trail_which_is_torn_by_a_jump() -> None:
    trail = DrivenTrail()
    assert len(trail.read(odometry(0.0)).shapes) == 1
    trail.read(odometry(0.5))
    assert len(trail_of(trail.read(odometry(0.505))).starts) == 1
    trail.read(odometry(9.0))
    assert trail_of(trail.read(odometry(9.5))).starts[:, 0].tolist() == [0.0, 9.0]


GRID, SCAN, CLOUD = read_grid, read_scan, read_cloud


def path_with_a_bad_pose() -> Tree:
    poses = [{"header": header(""), "pose": pose_tree(Transform((math.nan, 0.0, 0.0)))}]
    return {"header": header("map"), "poses": poses}


@pytest.mark.parametrize(
    ("read", "tree", "words"),
    [
        (GRID, grid(30_000, 40_000), "30000 by 40000 cells are announced, and 6 have come"),
        (GRID, grid(0, 5), "a map of 0 by 5 cells has none"),
        (GRID, grid(resolution=0.0), "info.resolution is 0 m a cell"),
        (GRID, grid(resolution=math.nan), "info.resolution is not a finite number"),
        (GRID, {"header": header("map")}, "the message has no field info.height"),
        (SCAN, scan(), "the scan has no ranges"),
        (SCAN, scan(1.0, angle_increment=math.nan), "angle_increment is not a finite number"),
        (SCAN, {**scan(1.0), "header": header("")},
         "header.frame_id is empty: the publisher names no frame"),
        (CLOUD, cloud_tree(THREE, "lidar", width=1000),
         "1000 points of 12 bytes are announced, and 36 bytes have come"),
        (CLOUD, cloud_tree(THREE, "lidar", width=2**31, height=2**31),
         "a cloud of 4611686018427387904 points is too large"),
        (CLOUD, cloud_tree(THREE, "lidar", point_step=8),
         "field z of the cloud ends behind its point_step of 8 bytes"),
        (CLOUD, cloud_tree(THREE, "lidar", height=2),
         "6 points of 12 bytes are announced, and 36 bytes have come"),
        (CLOUD, cloud_tree(THREE, "lidar", point_step=0),
         "field x of the cloud ends behind its point_step of 0 bytes"),
        (CLOUD, cloud_tree(THREE, "lidar", fields=[]), "the cloud has no field x, y, z"),
        (CLOUD, cloud_tree(THREE, "l", fields=[{"name": "x", "offset": 0, "datatype": 99}]),
         "the cloud has no field x, y, z"),
        (read_path, path_with_a_bad_pose(),
         "pose 0 of the path: pose.position.x is not a finite number"),
        (read_goal, {"header": header("map"), "pose": pose_tree(Transform((1e9, 0.0, 0.0)))},
         "pose.position is farther away than 1000 km"),
        (read_range, {"header": header("s"), "field_of_view": "wide"},
         "field_of_view is not a number"),
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_a_sentence(
    read: Callable[[Mapping[str, Any]], Drawable], tree: Tree, words: str
) -> None:
    with pytest.raises(NotDrawnError) as caught:
        read(tree)
    assert str(caught.value) == words


CART = """
<robot name="cart">
  <link name="base_link">
    <visual><origin xyz="1 0 0"/><geometry><box size="2 1 1"/></geometry></visual>
    <visual><geometry><cylinder radius="0.5" length="2"/></geometry></visual>
  </link>
  <link name="head">
    <visual><geometry><sphere radius="0.25"/></geometry></visual>
    <visual><geometry><mesh filename="package://cart/head.stl"/></geometry></visual>
  </link>
  <joint name="neck" type="fixed"><parent link="base_link"/><child link="head"/></joint>
</robot>
"""


def test_a_robot_is_the_shapes_of_its_links_in_their_frames() -> None:
    reader = ModelReader()
    reader.read({"data": CART}, 0.0)
    base, head = reader.shown(0.0)
    assert (base.frame, head.frame) == ("base_link", "head")
    block, wheel = base.shapes
    assert isinstance(block, Strokes)
    assert isinstance(wheel, Strokes)
    assert block.starts[..., 0].min() == pytest.approx(0.0)
    assert block.starts[..., 0].max() == pytest.approx(2.0)
    assert np.abs(wheel.starts[..., 2]).max() == pytest.approx(1.0)
    (ball,) = head.shapes
    assert isinstance(ball, Strokes)
    assert np.linalg.norm(ball.starts, axis=1).max() == pytest.approx(0.25)
    assert reader.remark == "shapes in files (mesh) are not drawn: 1"
