"""What messages become in Rerun."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from graph.data import Sample
from space.transform import Transform
from tests.unit.space.trees import cloud_tree, pose_tree
from view.scene import ViewScene
from view.shapes import Drawn

STILL = {"twist": {"linear": {"x": 0.0}, "angular": {"z": 0.0}}}
HEADER = {"stamp": {"sec": 1, "nanosec": 0}, "frame_id": "map"}


def draw(scene: ViewScene, topic: str, type_name: str, *messages: Mapping[str, Any]) -> dict[str, Drawn]:
    samples = [Sample(topic, type_name, 10.0 + i, 0.0, 1, one) for i, one in enumerate(messages)]
    return {"/".join(drawn.path): drawn for _time, drawn in scene.draw(samples)}


def transforms(*them: Mapping[str, Any]) -> dict[str, Any]:
    return {"transforms": list(them)}


def said(drawn: Mapping[str, Drawn]) -> str:
    found = drawn.get("log/deck")
    return "" if found is None else str(arrow(found.shapes[0].text)[0])


def arrow(batch: Any) -> list[Any]:
    found: list[Any] = batch.as_arrow_array().to_pylist()
    return found


CLOUD = "sensor_msgs/msg/PointCloud2"


def test_a_cloud_is_its_points_without_those_that_are_none() -> None:
    places = np.array([(1.0, 2.0, 3.0), (math.nan, 0.0, 0.0), (7.0, 8.0, 9.0)])
    drawn = draw(ViewScene(), "/points", CLOUD, cloud_tree(places, "map"))["space/points"]
    assert arrow(drawn.shapes[0].positions) == [[1.0, 2.0, 3.0], [7.0, 8.0, 9.0]]
    assert drawn.frame == "map"


def test_a_scan_is_points_in_its_plane_within_its_limits() -> None:
    message = {
        "header": HEADER,
        "angle_min": 0.0,
        "angle_increment": math.pi / 2,
        "range_min": 0.1,
        "range_max": 5.0,
        "ranges": np.array([1.0, 2.0, math.inf, 0.05], np.float32),
    }
    drawn = draw(ViewScene(), "/scan", "sensor_msgs/msg/LaserScan", message)["space/scan"]
    points = np.array(arrow(drawn.shapes[0].positions))
    assert points == pytest.approx(np.array([[1, 0, 0], [0, 2, 0]]), abs=1e-6)


def test_a_sonar_is_a_cone_and_a_number() -> None:
    drawn = draw(ViewScene(), "/sensor/sonar_front", "std_msgs/msg/Float32", {"data": 1.5})
    assert drawn["space/sensor/sonar_front"].frame == "sonar_front_link"
    for side in arrow(drawn["space/sensor/sonar_front"].shapes[0].strips):
        assert math.hypot(*side[-1]) == pytest.approx(1.5)
    assert arrow(drawn["plots/sensor/sonar_front"].shapes[0].scalars) == [1.5]


def test_a_robot_leaves_a_trail_which_is_torn_where_it_was_not_driven() -> None:
    messages = [
        {"header": HEADER, "pose": {"pose": pose_tree(Transform((x, 0.0, 0.0)))}, "twist": STILL}
        for x in (0.0, 0.5, 1.0, 9.0, 9.5)
    ]
    drawn = draw(ViewScene(), "/odom", "nav_msgs/msg/Odometry", *messages)
    assert arrow(drawn["space/odom"].shapes[0].origins) == [[9.5, 0.0, 0.0]]
    strips = arrow(drawn["space/odom/trail"].shapes[0].strips)
    assert [[x for x, _, _ in strip] for strip in strips] == [[0.0, 0.5, 1.0], [9.0, 9.5]]


def image(encoding: str, pixels: np.ndarray[Any, Any], **changes: Any) -> dict[str, Any]:
    height, width = pixels.shape[:2]
    whole = {
        "header": HEADER,
        "height": height,
        "width": width,
        "encoding": encoding,
        "is_bigendian": 0,
        "step": pixels.nbytes // height,
        "data": pixels.tobytes(),
    }
    return {**whole, **changes}


def test_a_picture_has_its_colours_to_the_byte() -> None:
    pixels = np.array([[[1, 2, 3], [4, 5, 6]]], np.uint8)
    drawn = draw(ViewScene(), "/image", "sensor_msgs/msg/Image", image("bgr8", pixels))
    assert bytes(arrow(drawn["pictures/image"].shapes[0].buffer)[0]) == bytes([3, 2, 1, 6, 5, 4])


def test_a_message_of_another_shape_ends_nothing() -> None:
    drawn = draw(ViewScene(), "/tf", "std_msgs/msg/String", {"data": "?"})
    assert "the message has no field transforms" in said(drawn)
