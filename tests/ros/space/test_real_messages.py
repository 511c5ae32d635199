"""Readers on real messages: serialized by rclpy, decoded as the observer does, or hostile."""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.serialization import serialize_message
from sensor_msgs.msg import PointCloud2, PointField

from graph.messages.definitions import decoder
from graph.messages.fields import to_tree
from graph.messages.making import to_message
from graph.messages.types import load_message
from space.drawing.camera import SpaceCamera
from space.drawing.raster import Raster
from space.drawing.scene import draw
from space.drawing.shapes import Speckles
from space.reading.fields import Drawable, NotDrawnError
from space.reading.kinds import KINDS
from tests.ros.any_message import trees_of


def read(type_name: str, *messages: Any) -> list[Drawable]:
    """Return what messages show after they went over the wire."""
    decode, reader = decoder(type_name), KINDS[type_name].make()
    for message in messages:
        reader.read(decode(serialize_message(message)), 0.0)
    return list(reader.shown(0.0))


def cloud(count: int = 1000, *, dtype: str = "<f4") -> PointCloud2:
    kind = PointField.FLOAT32 if dtype.endswith("4") else PointField.FLOAT64
    size = int(dtype[-1])
    fields = [PointField(name=name, offset=size * at, datatype=kind, count=1) for at, name in enumerate("xyz")]
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


@pytest.mark.parametrize("type_name", KINDS)
@settings(max_examples=40, deadline=None, derandomize=True)
@given(data=st.data())
def test_whatever_is_in_a_message_is_drawn_or_a_sentence(type_name: str, data: st.DataObject) -> None:
    tree = to_tree(to_message(load_message(type_name), data.draw(trees_of(load_message(type_name)))))
    reader = KINDS[type_name].make()
    with contextlib.suppress(NotDrawnError):
        reader.read(tree, 0.0)
    shapes = [shape for drawable in reader.shown(0.0) for shape in drawable.shapes]
    draw(Raster(20, 10), SpaceCamera(), shapes)
