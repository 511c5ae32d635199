"""Readers on real messages: serialized by rclpy, decoded as the observer does, or hostile."""

from __future__ import annotations

import contextlib
import math
from typing import Any

import numpy as np
import pytest
from builtin_interfaces.msg import Duration
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from hypothesis import given, settings
from hypothesis import strategies as st
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import LaserScan, PointCloud2, PointField, Range

from graph.messages.decoding import decoder, read_point_cloud
from graph.messages.making import to_message
from graph.messages.types import load_message
from graph.messages.values import to_tree
from space.drawing.camera import SpaceCamera
from space.drawing.raster import Raster
from space.drawing.scene import draw
from space.drawing.shapes import Floor, Speckles, Strokes
from space.reading.fields import Drawable, NotDrawnError
from space.reading.kinds import KINDS
from tests.ros.any_message import trees_of


def read(type_name: str, *messages: Any) -> list[Drawable]:
    """Return what messages show after they went over the wire."""
    decode, reader = decoder(type_name), KINDS[type_name].make()
    for message in messages:
        reader.read(decode(serialize_message(message)), 0.0)
    return list(reader.shown(0.0))


def pose(x: float, y: float) -> Pose:
    """A pose without rotation."""
    return Pose(position=Point(x=x, y=y), orientation=Quaternion(w=1.0))


def cloud(count: int = 1000, *, dtype: str = "<f4") -> PointCloud2:
    """A cloud along a diagonal."""
    kind = PointField.FLOAT32 if dtype.endswith("4") else PointField.FLOAT64
    size = int(dtype[-1])
    fields = [
        PointField(name=name, offset=size * at, datatype=kind, count=1)
        for at, name in enumerate("xyz")
    ]
    made = PointCloud2(height=1, width=count, fields=fields, point_step=3 * size)
    made.header.frame_id = "lidar"
    made.is_bigendian = dtype.startswith(">")
    made.row_step = made.point_step * count
    diagonal = np.linspace(0, 1, count)
    made.data.frombytes(np.column_stack([diagonal] * 3).astype(dtype).tobytes())
    return made


@pytest.mark.parametrize("dtype", ["<f4", ">f4", "<f8", ">f8"])
def test_a_real_cloud(dtype: str) -> None:
    (drawable,) = read("sensor_msgs/msg/PointCloud2", cloud(dtype=dtype))
    (shape,) = drawable.shapes
    assert isinstance(shape, Speckles)
    assert shape.places.shape == (1000, 3)
    assert shape.places[-1].tolist() == [1, 1, 1]


def test_a_real_map_scan_path_range_and_odometry() -> None:
    grid = OccupancyGrid(data=[0, 100, -1, 50])
    grid.header.frame_id = "map"
    grid.info.width = grid.info.height = 2
    grid.info.resolution = 0.05
    scan = LaserScan(angle_increment=0.1, range_max=math.inf, ranges=[1.0, math.nan, 2.0])
    scan.header.frame_id = "laser"
    path = Path(poses=[PoseStamped(pose=pose(0.0, 0.0)), PoseStamped(pose=pose(1.0, 0.0))])
    path.header.frame_id = "map"
    cone = Range(field_of_view=0.3, max_range=4.0, range=1.0)
    cone.header.frame_id = "sonar"
    driven = Odometry()
    driven.header.frame_id = "odom"
    driven.pose.pose = pose(1.0, 2.0)
    goal = PoseStamped(pose=pose(1.0, 2.0))
    goal.header.frame_id = "map"
    expected = {
        "nav_msgs/msg/OccupancyGrid": (grid, Floor),
        "sensor_msgs/msg/LaserScan": (scan, Speckles),
        "nav_msgs/msg/Path": (path, Strokes),
        "sensor_msgs/msg/Range": (cone, Strokes),
        "nav_msgs/msg/Odometry": (driven, object),
        "geometry_msgs/msg/PoseStamped": (goal, Strokes),
    }
    for type_name, (message, shape) in expected.items():
        (drawable,) = read(type_name, message)
        assert isinstance(drawable.shapes[0], shape), type_name


def test_real_markers() -> None:
    Marker = load_message("visualization_msgs/msg/Marker")  # noqa: N806
    MarkerArray = load_message("visualization_msgs/msg/MarkerArray")  # noqa: N806
    one = Marker(ns="a", type=Marker.CUBE, action=Marker.ADD, lifetime=Duration(sec=5))
    one.header.frame_id = "map"
    one.pose = pose(1.0, 0.0)
    one.scale.x = one.scale.y = one.scale.z = 1.0
    other = Marker(ns="a", id=1, type=Marker.MESH_RESOURCE)
    other.header.frame_id = "map"
    assert len(read("visualization_msgs/msg/MarkerArray", MarkerArray(markers=[one, other]))) == 1
    assert len(read("visualization_msgs/msg/Marker", one)) == 1
    assert read("visualization_msgs/msg/Marker", one, Marker(action=Marker.DELETEALL)) == []


@settings(max_examples=50, deadline=None, derandomize=True)
@given(tree=trees_of(load_message("sensor_msgs/msg/PointCloud2")), cut=st.integers(0, 60))
def test_clouds_are_decoded_the_short_way_as_by_rclpy(tree: dict[str, Any], cut: int) -> None:
    cls = load_message("sensor_msgs/msg/PointCloud2")
    raw = serialize_message(to_message(cls, tree))
    assert read_point_cloud(raw) == to_tree(deserialize_message(raw, cls))
    # Cut short, or in another byte order, it is left to rclpy.
    padding = 4
    if cut >= padding:
        assert read_point_cloud(raw[:-cut]) is None
    assert read_point_cloud(b"\x00\x00" + raw[2:]) is None


def test_a_cloud_that_announces_more_fields_than_it_has_is_left_to_rclpy() -> None:
    raw = bytearray(serialize_message(cloud(1)))
    # After the header of four bytes: stamp, frame, height and width.
    at = 4 + 8 + 4 + 8 + 8
    assert int.from_bytes(raw[at : at + 4], "little") == 3
    raw[at : at + 4] = b"\xff\xff\xff\x7f"
    assert read_point_cloud(bytes(raw)) is None


@pytest.mark.parametrize("type_name", KINDS)
@settings(max_examples=40, deadline=None, derandomize=True)
@given(data=st.data())
def test_whatever_is_in_a_message_is_drawn_or_a_sentence(
    type_name: str, data: st.DataObject
) -> None:
    tree = to_tree(
        to_message(load_message(type_name), data.draw(trees_of(load_message(type_name))))
    )
    reader = KINDS[type_name].make()
    with contextlib.suppress(NotDrawnError):
        reader.read(tree, 0.0)
    shapes = [shape for drawable in reader.shown(0.0) for shape in drawable.shapes]
    draw(Raster(20, 10), SpaceCamera(), shapes)
