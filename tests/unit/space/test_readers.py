"""What messages show, and the sentence for each that shows nothing."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

from space.drawing.paints import RAMP_FROM, RAMP_STEPS, Tint, nearest
from space.drawing.shapes import Faces, Floor, Sign, Speckles, Strokes
from space.reading.clouds import read_cloud
from space.reading.fields import Drawable, NotDrawnError
from space.reading.grids import read_grid
from space.reading.poses import DrivenTrail, SteadyGoal, read_path, read_pose
from space.reading.robot import ModelReader
from space.reading.scans import SteadyRay, read_scan
from space.transform import Transform
from tests.unit.space.trees import cloud_tree, header, pose_tree

Tree = dict[str, Any]
THREE = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]])


def grid(columns: int = 3, rows: int = 2, **more: Any) -> Tree:
    """A map with a free, an unknown, an occupied and three doubtful cells."""
    info = {
        "resolution": 0.5,
        "width": columns,
        "height": rows,
        "origin": pose_tree(Transform((1.0, 2.0, 0.0))),
    }
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
    """The only shape."""
    (shape,) = drawable.shapes
    assert isinstance(shape, Speckles)
    return shape


def test_a_map_is_a_floor_of_free_occupied_and_doubtful_cells() -> None:
    drawable = read_grid(grid())
    (floor,) = drawable.shapes
    assert isinstance(floor, Floor)
    assert floor.cells.tolist() == [
        [Tint.FREE, Tint.NOTHING, Tint.WALL],
        [Tint.MAYBE, Tint.MAYBE, Tint.MAYBE],
    ]
    assert (floor.cell_m, floor.origin.translation) == (0.5, (1.0, 2.0, 0.0))
    assert drawable.frame == "map"


def test_a_very_large_map_keeps_its_walls() -> None:
    cells = np.zeros((3000, 3000), dtype=np.int8)
    cells[1501, :] = 100
    (floor,) = read_grid({**grid(3000, 3000), "data": cells.ravel()}).shapes
    assert isinstance(floor, Floor)
    assert floor.cells.size < 4_000_000
    assert (floor.cells == Tint.WALL).any(axis=0).all()
    assert floor.cells.shape[0] * floor.cell_m == pytest.approx(1500)


def test_a_scan_is_where_its_rays_end() -> None:
    places = speckles(read_scan(scan(1.0, 2.0, 3.0))).places
    assert places == pytest.approx(np.array([[1, 0, 0], [0, 2, 0], [-3, 0, 0]]), abs=1e-6)


def test_ranges_that_are_not_valid_are_left_out() -> None:
    found = read_scan(scan(math.nan, math.inf, 0.01, 20.0, 1.0))
    assert len(speckles(found).places) == 1
    assert found.remark is None
    nothing = read_scan(scan(math.nan, math.inf))
    assert nothing.remark == "no range is valid, of 2"


def test_a_range_is_a_cone_as_long_as_it_measures() -> None:
    tree = {"header": header("sonar"), "field_of_view": 0.5, "range": 2.0, "max_range": 4.0}
    cone, rim = SteadyRay().read_range(tree).shapes
    assert isinstance(cone, Strokes)
    assert isinstance(rim, Strokes)
    assert np.linalg.norm(cone.ends, axis=1) == pytest.approx(2.0)
    assert cone.ends[:, 1].max() == pytest.approx(2.0 * math.sin(0.25))
    assert cone.paint == Tint.WARN


@pytest.mark.parametrize(
    ("metres", "paint"), [(1.0, Tint.WARN), (math.inf, Tint.MUTED), (math.nan, Tint.MUTED)]
)
def test_a_bare_sonar_shows_what_rep_117_says(metres: float, paint: Tint) -> None:
    drawable = SteadyRay().read_sonar({"data": metres}, "sonar_front_link")
    first = drawable.shapes[0]
    assert isinstance(first, Strokes)
    assert first.paint == paint
    assert drawable.frame == "sonar_front_link"
    assert any(isinstance(shape, Sign) for shape in drawable.shapes) == math.isnan(metres)


def test_a_distance_that_only_fluctuates_stays_the_same_drawing() -> None:
    ray = SteadyRay()
    first = ray.read_sonar({"data": 1.0}, "sonar")
    assert ray.read_sonar({"data": 1.02}, "sonar") is first
    assert ray.read_sonar({"data": 1.04}, "sonar") is not first
    assert ray.read_sonar({"data": math.inf}, "sonar") is not ray.read_sonar({"data": 1.0}, "other")


def test_a_pose_that_stands_stays_the_same_drawing() -> None:
    steady = SteadyGoal()
    first, near, far = (
        steady.read({"header": header("map"), "pose": pose_tree(Transform((x, 0.0, 0.0)))})
        for x in (1.0, 1.0005, 1.1)
    )
    assert near is first
    assert far is not first


def test_a_robot_that_stands_stays_the_same_drawing() -> None:
    trail = DrivenTrail()
    first = trail.read(odometry(1.0))
    assert trail.read(odometry(1.0005)) is first
    assert trail.read(odometry(1.01)) is not first


def test_a_cloud_is_its_points_coloured_by_height() -> None:
    shape = speckles(read_cloud(cloud_tree(THREE, "lidar")))
    assert shape.places.tolist() == THREE.tolist()
    assert isinstance(shape.paint, np.ndarray)
    assert shape.paint[0] == RAMP_FROM
    assert shape.paint[-1] == RAMP_FROM + RAMP_STEPS - 1


def packed(order: str, kind: str, layout: Mapping[str, int], step: int, **more: Any) -> Tree:
    """A cloud in any layout: name to offset, all of one kind."""
    kinds = np.dtype(
        {
            "names": list(layout),
            "formats": [order + kind] * len(layout),
            "offsets": list(layout.values()),
            "itemsize": step,
        }
    )
    data = np.zeros(3, dtype=kinds)
    for axis, name in enumerate("xyz"):
        data[name] = THREE[:, axis]
    for name in set(layout) - set("xyz"):
        data[name] = [10.0, 20.0, 30.0]
    number = {"f4": 7, "f8": 8}[kind]
    fields = [
        {"name": name, "offset": at, "datatype": number, "count": 1} for name, at in layout.items()
    ]
    return cloud_tree(
        THREE,
        "lidar",
        fields=fields,
        point_step=step,
        row_step=3 * step,
        is_bigendian=order == ">",
        data=data.tobytes(),
        **more,
    )


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("kind", ["f4", "f8"])
def test_a_cloud_may_have_any_layout(order: str, kind: str) -> None:
    shape = speckles(
        read_cloud(packed(order, kind, {"z": 3, "intensity": 40, "x": 20, "y": 11}, 51))
    )
    assert shape.places.tolist() == THREE.tolist()
    assert isinstance(shape.paint, np.ndarray)
    assert shape.paint[0] < shape.paint[1] < shape.paint[2]


def test_rgb_is_packed_into_the_bits_of_a_float() -> None:
    bits = np.array([0xFF0000, 0x00FF00, 0x0000FF], dtype=np.uint32).view(np.float32)
    tree = packed("<", "f4", {"x": 0, "y": 4, "z": 8, "rgb": 12}, 16)
    data = np.frombuffer(tree["data"], dtype="<f4").reshape(3, 4).copy()
    data[:, 3] = bits
    shape = speckles(read_cloud({**tree, "data": data.tobytes()}))
    assert isinstance(shape.paint, np.ndarray)
    assert shape.paint.tolist() == [nearest(1, 0, 0), nearest(0, 1, 0), nearest(0, 0, 1)]


def test_rows_of_a_cloud_may_be_padded() -> None:
    rows = [THREE[:2].astype("<f4").tobytes() + b"pad!", THREE[1:].astype("<f4").tobytes()]
    tree = cloud_tree(THREE, "lidar", height=2, width=2, row_step=28, data=b"".join(rows))
    assert speckles(read_cloud(tree)).places.tolist() == THREE[[0, 1, 1, 2]].tolist()


def test_nan_and_infinity_are_dropped() -> None:
    broken = np.array([[math.nan, 0, 0], [1, 2, 3], [0, math.inf, 0], [0, 0, 1e30]])
    assert speckles(read_cloud(cloud_tree(broken, "lidar"))).places.tolist() == [[1, 2, 3]]
    nothing = read_cloud(cloud_tree(broken[:1], "lidar"))
    assert nothing.remark == "no point is a place: NaN or too far away, all 1"


def test_an_empty_cloud_is_no_mistake() -> None:
    found = read_cloud(cloud_tree(THREE[:0], "lidar"))
    assert (len(speckles(found).places), found.remark) == (0, None)


def test_a_pose_is_an_arrow_along_its_x() -> None:
    at = Transform.from_rpy((1.0, 2.0, 0.0), (0.0, 0.0, math.pi / 2))
    (shape,) = read_pose({"header": header("map"), "pose": pose_tree(at)}).shapes
    assert isinstance(shape, Strokes)
    assert shape.ends[0].tolist() == pytest.approx([1.0, 2.4, 0.0])


def test_a_goal_without_a_frame_says_that_there_is_none() -> None:
    found = SteadyGoal().read({"header": header(""), "pose": pose_tree(Transform())})
    assert (found.shapes, found.remark) == ((), "there is no goal now")


def test_a_path_goes_from_pose_to_pose_in_one_frame() -> None:
    poses = [
        {"header": header(frame), "pose": pose_tree(Transform((float(x), 0.0, 0.0)))}
        for x, frame in enumerate(["", "map", "odom", "/map"])
    ]
    found = read_path({"header": header("map"), "poses": poses})
    (shape,) = found.shapes
    assert isinstance(shape, Strokes)
    assert shape.ends[:, 0].tolist() == [1.0, 3.0]
    assert found.remark == "poses in other frames are not drawn: 1"


def odometry(x: float, frame: str = "odom") -> Tree:
    """An odometry on the x axis."""
    return {"header": header(frame), "pose": {"pose": pose_tree(Transform((x, 0.0, 0.0)))}}


def trail_of(drawable: Drawable) -> Strokes:
    """The line behind the dart."""
    dart, line = drawable.shapes
    assert isinstance(dart, Faces)
    assert isinstance(line, Strokes)
    return line


def test_odometry_leaves_a_trail_which_is_torn_by_a_jump() -> None:
    trail = DrivenTrail()
    assert len(trail.read(odometry(0.0)).shapes) == 1
    trail.read(odometry(0.5))
    assert len(trail_of(trail.read(odometry(0.505))).starts) == 1
    trail.read(odometry(9.0))
    assert trail_of(trail.read(odometry(9.5))).starts[:, 0].tolist() == [0.0, 9.0]


def test_a_trail_in_another_frame_begins_anew() -> None:
    trail = DrivenTrail()
    trail.read(odometry(0.0))
    assert len(trail.read(odometry(0.5, "map")).shapes) == 1


def test_a_long_trail_is_thinned() -> None:
    trail = DrivenTrail()
    for step in range(5_000):
        last = trail.read(odometry(0.03 * step))
    line = trail_of(last)
    assert 1000 < len(line.starts) <= 4000
    assert line.starts[0, 0] == 0.0


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
        (
            SCAN,
            {**scan(1.0), "header": header("")},
            "header.frame_id is empty: the publisher names no frame",
        ),
        (
            CLOUD,
            cloud_tree(THREE, "lidar", width=1000),
            "1000 points of 12 bytes are announced, and 36 bytes have come",
        ),
        (
            CLOUD,
            cloud_tree(THREE, "lidar", width=2**31, height=2**31),
            "a cloud of 4611686018427387904 points is too large",
        ),
        (
            CLOUD,
            cloud_tree(THREE, "lidar", point_step=8),
            "field z of the cloud ends behind its point_step of 8 bytes",
        ),
        (
            CLOUD,
            cloud_tree(THREE, "lidar", height=2),
            "6 points of 12 bytes are announced, and 36 bytes have come",
        ),
        (
            CLOUD,
            cloud_tree(THREE, "lidar", point_step=0),
            "field x of the cloud ends behind its point_step of 0 bytes",
        ),
        (CLOUD, cloud_tree(THREE, "lidar", fields=[]), "the cloud has no field x, y, z"),
        (
            CLOUD,
            cloud_tree(THREE, "l", fields=[{"name": "x", "offset": 0, "datatype": 99}]),
            "the cloud has no field x, y, z",
        ),
        (
            read_path,
            path_with_a_bad_pose(),
            "pose 0 of the path: pose.position.x is not a finite number",
        ),
        (
            read_pose,
            {"header": header("map"), "pose": pose_tree(Transform((1e9, 0.0, 0.0)))},
            "pose.position is farther away than 1000 km",
        ),
        (
            SteadyRay().read_range,
            {"header": header("s"), "field_of_view": "wide"},
            "field_of_view is not a number",
        ),
    ],
)
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
    assert isinstance(block, Faces)
    assert isinstance(wheel, Faces)
    assert block.corners[..., 0].min() == pytest.approx(0.0)
    assert block.corners[..., 0].max() == pytest.approx(2.0)
    assert np.abs(wheel.corners[..., 2]).max() == pytest.approx(1.0)
    (ball,) = head.shapes
    assert isinstance(ball, Faces)
    assert np.linalg.norm(ball.corners, axis=2).max() == pytest.approx(0.25)
    assert reader.remark == "shapes in files (mesh) are not drawn: 1"


def test_what_describes_no_robot_is_a_sentence_and_shows_none() -> None:
    reader = ModelReader()
    reader.read({"data": CART}, 0.0)
    with pytest.raises(NotDrawnError, match="line 1"):
        reader.read({"data": "<robot"}, 0.0)
    assert not reader.shown(0.0)
    with pytest.raises(NotDrawnError, match="data is not a text"):
        reader.read({"data": 5}, 0.0)
