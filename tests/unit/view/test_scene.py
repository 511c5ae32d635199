"""What messages become in Rerun, and what is said of those that become nothing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from graph.data import Sample, TopicRow
from space.transform import Transform
from tests.unit.space.trees import cloud_tree, marker, pose_tree
from view.scene.drawn import Drawn
from view.scene.scene import ViewScene

NO_TURN = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
STILL = {"twist": {"linear": {"x": 0.0}, "angular": {"z": 0.0}}}
ORIGIN = {"x": 0.0, "y": 0.0, "z": 0.0}
HEADER = {"stamp": {"sec": 1, "nanosec": 0}, "frame_id": "map"}


def draw(
    scene: ViewScene, topic: str, type_name: str, *messages: Mapping[str, Any]
) -> dict[str, Drawn]:
    """Return what is drawn of these messages, the newest at each entity."""
    samples = [Sample(topic, type_name, 10.0 + i, 0.0, 1, one) for i, one in enumerate(messages)]
    return {"/".join(drawn.path): drawn for _time, drawn in scene.draw(samples)}


def moved(parent: str, child: str, x: float = 1.0, rotation: Any = NO_TURN) -> dict[str, Any]:
    place = {"translation": {"x": x, "y": 0.0, "z": 0.0}, "rotation": rotation}
    return {"header": {**HEADER, "frame_id": parent}, "child_frame_id": child, "transform": place}


def transforms(*them: Mapping[str, Any]) -> dict[str, Any]:
    return {"transforms": list(them)}


def said(drawn: Mapping[str, Drawn]) -> str:
    """Return what Deck says in the viewer's log."""
    found = drawn.get("log/deck")
    return "" if found is None else str(arrow(found.shapes[0].text)[0])


def arrow(batch: Any) -> list[Any]:
    found: list[Any] = batch.as_arrow_array().to_pylist()
    return found


def frames_of(drawn: Drawn) -> tuple[str, str]:
    """Return parent and child of a transform."""
    place = drawn.shapes[0]
    return arrow(place.parent_frame)[0], arrow(place.child_frame)[0]


def test_pictures_from_another_machine_are_seen_small() -> None:
    """Of everything else the whole is needed, and pictures from this machine cost no network."""
    rows = [
        TopicRow(name, (type_name,), 1, 0, from_afar=from_afar)
        for name, type_name, from_afar in (
            ("/far", "sensor_msgs/msg/Image", True),
            ("/far/compressed", "sensor_msgs/msg/CompressedImage", True),
            ("/far/points", "sensor_msgs/msg/PointCloud2", True),
            ("/here", "sensor_msgs/msg/Image", False),
        )
    ]
    scene = ViewScene()
    assert scene.seen_small(rows) == {"/far", "/far/compressed"}
    assert scene.wanted(rows) == {row.name for row in rows}


def test_frames_stand_in_their_parents_and_a_root_in_the_view() -> None:
    drawn = draw(ViewScene(), "/tf", "tf2_msgs/msg/TFMessage", transforms(moved("/odom", "base")))
    assert frames_of(drawn["frames/base"]) == ("odom", "base")
    assert arrow(drawn["frames/base"].shapes[0].translation) == [[1.0, 0.0, 0.0]]
    assert frames_of(drawn["frames/odom"]) == ("tf#/", "odom")


def test_a_frame_may_be_in_the_middle_of_the_earth() -> None:
    message = transforms(moved("earth", "map", 6_371_000.0))
    drawn = draw(ViewScene(), "/tf_static", "tf2_msgs/msg/TFMessage", message)
    assert not said(drawn)
    assert frames_of(drawn["frames/map"]) == ("earth", "map")


def test_of_many_transforms_the_newest_of_each_frame_is_drawn() -> None:
    messages = (
        transforms(moved("odom", "base", 1.0), moved("base", "head", 1.0)),
        transforms(moved("odom", "base", 2.0)),
    )
    samples = [Sample("/tf", "tf2_msgs/msg/TFMessage", 10.0, 0.0, 1, one) for one in messages]
    drawn = [one for _time, one in ViewScene().draw(samples) if one.path == ("frames", "base")]
    places = [arrow(one.shapes[0].translation) for one in drawn if not one.static]
    assert places == [[[2.0, 0.0, 0.0]]]


def test_a_root_that_gets_a_parent_is_none_any_more() -> None:
    scene = ViewScene()
    draw(scene, "/tf", "tf2_msgs/msg/TFMessage", transforms(moved("odom", "base")))
    drawn = draw(scene, "/tf", "tf2_msgs/msg/TFMessage", transforms(moved("map", "odom")))
    assert frames_of(drawn["frames/odom"]) == ("map", "odom")
    assert frames_of(drawn["frames/map"]) == ("tf#/", "map")


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        (moved("a", "a"), "joins no two frames"),
        (moved("", "b"), "joins no two frames"),
        (moved("a", "b", math.nan), "b in a: transform.translation.x is not a finite number"),
        (moved("a", "b", 1e300), "b in a: transform.translation is farther away than 100000 km"),
        (moved("b", "a"), "closes a loop"),
    ],
)
def test_a_bad_transform_is_told_of_and_the_others_are_drawn(
    bad: Mapping[str, Any], words: str
) -> None:
    message = transforms(moved("a", "b"), bad, moved("a", "c"))
    drawn = draw(ViewScene(), "/tf", "tf2_msgs/msg/TFMessage", message)
    assert words in said(drawn)
    assert frames_of(drawn["frames/c"]) == ("a", "c")


def test_a_fault_is_told_once() -> None:
    scene = ViewScene()
    bad = transforms(moved("a", "a"))
    assert said(draw(scene, "/tf", "tf2_msgs/msg/TFMessage", bad))
    assert not said(draw(scene, "/tf", "tf2_msgs/msg/TFMessage", bad))
    draw(scene, "/tf", "tf2_msgs/msg/TFMessage", transforms(moved("a", "b")))
    assert said(draw(scene, "/tf", "tf2_msgs/msg/TFMessage", bad))


def test_names_from_outside_can_do_no_harm() -> None:
    drawn = draw(
        ViewScene(), "/tf", "tf2_msgs/msg/TFMessage", transforms(moved("tf#/", "a\x1b[31m/b"))
    )
    (child,) = (drawn[path] for path in drawn if "b" in path)
    assert frames_of(child) == ("_tf#/", "a␛[31m/b")


CLOUD = "sensor_msgs/msg/PointCloud2"


def test_a_cloud_is_its_points_without_those_that_are_none() -> None:
    places = np.array([(1.0, 2.0, 3.0), (math.nan, 0.0, 0.0), (7.0, 8.0, 9.0)])
    drawn = draw(ViewScene(), "/points", CLOUD, cloud_tree(places, "map"))["space/points"]
    assert arrow(drawn.shapes[0].positions) == [[1.0, 2.0, 3.0], [7.0, 8.0, 9.0]]
    assert drawn.frame == "map"


def test_a_cloud_has_its_colours_to_the_byte() -> None:
    records = np.array([(1.0, 2.0, 3.0, 0x0A141E)], "<f4,<f4,<f4,<u4")
    fields = [
        {"name": name, "offset": 4 * at, "datatype": 7, "count": 1}
        for at, name in enumerate(("x", "y", "z", "rgb"))
    ]
    message = cloud_tree(
        np.zeros((1, 3)), "map", fields=fields, point_step=16, row_step=16, data=records.tobytes()
    )
    drawn = draw(ViewScene(), "/points", CLOUD, message)["space/points"]
    assert arrow(drawn.shapes[0].colors) == [0x0A141EFF]


def test_a_large_cloud_is_thinned_out() -> None:
    message = cloud_tree(np.zeros((300_000, 3)), "map")
    drawn = draw(ViewScene(), "/points", CLOUD, message)["space/points"]
    assert len(arrow(drawn.shapes[0].positions)) == 100_000


def test_a_cloud_that_does_not_fit_is_told_of() -> None:
    message = cloud_tree(np.zeros((1, 3)), "map", fields=[])
    drawn = draw(ViewScene(), "/points", CLOUD, message)
    assert "space/points" not in drawn
    assert said(drawn) == "/points is not drawn: the cloud has no field x, y, z"


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


def test_a_map_is_turned_upright() -> None:
    info = {
        "width": 2,
        "height": 2,
        "resolution": 0.5,
        "origin": {"position": ORIGIN, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 0.0}},
    }
    message = {"header": HEADER, "info": info, "data": np.array([0, 100, -1, 50], np.int8)}
    drawn = draw(ViewScene(), "/map", "nav_msgs/msg/OccupancyGrid", message)["space/map"]
    assert bytes(arrow(drawn.shapes[0].data)[0]) == bytes([255, 50, 0, 100])


def test_a_sonar_is_a_cone_and_a_number() -> None:
    drawn = draw(ViewScene(), "/sensor/sonar_front", "std_msgs/msg/Float32", {"data": 1.5})
    assert drawn["space/sensor/sonar_front"].frame == "sonar_front_link"
    for side in arrow(drawn["space/sensor/sonar_front"].shapes[0].strips):
        assert math.hypot(*side[-1]) == pytest.approx(1.5)
    assert arrow(drawn["plots/sensor/sonar_front"].shapes[0].scalars) == [1.5]


def test_nothing_in_range_is_a_cone_of_another_colour_and_no_number() -> None:
    near, clear = (
        draw(ViewScene(), "/sensor/sonar_front", "std_msgs/msg/Float32", {"data": metres})
        for metres in (1.5, math.inf)
    )
    colours = [
        set(arrow(drawn["space/sensor/sonar_front"].shapes[0].colors)) for drawn in (near, clear)
    ]
    assert colours[0].isdisjoint(colours[1])
    assert "plots/sensor/sonar_front" not in clear


def test_a_range_is_a_cone_of_its_width() -> None:
    message = {"header": HEADER, "field_of_view": 1.0, "range": 2.0, "max_range": 4.0}
    drawn = draw(ViewScene(), "/sonar/range", "sensor_msgs/msg/Range", message)
    rim = np.array(arrow(drawn["space/sonar/range"].shapes[0].strips)[-1])
    assert np.linalg.norm(rim, axis=1) == pytest.approx(2.0)
    assert rim[:, 0] == pytest.approx(2.0 * math.cos(0.5))


def test_a_robot_leaves_a_trail_which_is_torn_where_it_was_not_driven() -> None:
    messages = [
        {"header": HEADER, "pose": {"pose": pose_tree(Transform((x, 0.0, 0.0)))}, "twist": STILL}
        for x in (0.0, 0.5, 1.0, 9.0, 9.5)
    ]
    drawn = draw(ViewScene(), "/odom", "nav_msgs/msg/Odometry", *messages)
    assert arrow(drawn["space/odom"].shapes[0].origins) == [[9.5, 0.0, 0.0]]
    strips = arrow(drawn["space/odom/trail"].shapes[0].strips)
    assert [[x for x, _, _ in strip] for strip in strips] == [[0.0, 0.5, 1.0], [9.0, 9.5]]


def test_a_path_is_a_line_through_its_poses() -> None:
    poses = [
        {"header": HEADER, "pose": pose_tree(Transform((float(x), 0.0, 0.0)))} for x in range(3)
    ]
    drawn = draw(ViewScene(), "/plan", "nav_msgs/msg/Path", {"header": HEADER, "poses": poses})
    assert arrow(drawn["space/plan"].shapes[0].strips) == [[[0, 0, 0], [1, 0, 0], [2, 0, 0]]]
    assert not said(drawn)
    poses[1]["header"] = {**HEADER, "frame_id": "odom"}
    drawn = draw(ViewScene(), "/plan", "nav_msgs/msg/Path", {"header": HEADER, "poses": poses})
    assert arrow(drawn["space/plan"].shapes[0].strips) == [[[0, 0, 0], [2, 0, 0]]]
    assert said(drawn).endswith("poses in other frames are not drawn: 1")


@pytest.mark.parametrize("kind", ["PoseStamped", "PoseWithCovarianceStamped", "PoseArray"])
def test_poses_are_arrows_along_their_x(kind: str) -> None:
    one = pose_tree(Transform.from_rpy((1.0, 2.0, 0.0), (0.0, 0.0, math.pi / 2)))
    pose = {"pose": one} if kind == "PoseWithCovarianceStamped" else one
    message = {"header": HEADER, "pose": pose, "poses": [one]}
    drawn = draw(ViewScene(), "/goal", f"geometry_msgs/msg/{kind}", message)
    shape = drawn["space/goal"].shapes[0]
    assert arrow(shape.origins) == [[1.0, 2.0, 0.0]]
    assert arrow(shape.vectors) == [pytest.approx([0.0, 0.3, 0.0])]


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


def test_over_a_slow_line_it_is_a_jpeg() -> None:
    pixels = np.zeros((240, 320, 3), np.uint8)
    scene = ViewScene(compact=True)
    drawn = draw(scene, "/image", "sensor_msgs/msg/Image", image("rgb8", pixels))
    blob = bytes(arrow(drawn["pictures/image"].shapes[0].blob)[0])
    assert blob.startswith(b"\xff\xd8\xff")
    assert len(blob) < 5000


@pytest.mark.parametrize(("encoding", "kind", "metre"), [("16UC1", "u2", 1000), ("32FC1", "f4", 1)])
def test_depth_is_in_metres(encoding: str, kind: str, metre: float) -> None:
    pixels = np.array([[1, 2], [3, 4]], kind)
    drawn = draw(ViewScene(), "/depth", "sensor_msgs/msg/Image", image(encoding, pixels))
    shape = drawn["pictures/depth"].shapes[0]
    assert arrow(shape.meter) == [metre]
    assert bytes(arrow(shape.buffer)[0]) == pixels.tobytes()


def test_a_picture_that_is_cut_off_is_told_of() -> None:
    message = image("rgb8", np.zeros((4, 4, 3), np.uint8), data=b"123")
    assert "/image is not drawn" in said(
        draw(ViewScene(), "/image", "sensor_msgs/msg/Image", message)
    )


MARKER = marker(3, 2, Transform((1.0, 0.0, 0.0)), (0.1, 0.1, 0.1))


@pytest.mark.parametrize("kind", [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 11])
def test_every_kind_of_marker_is_drawn(kind: int) -> None:
    points = [{"x": float(x), "y": 0.0, "z": 0.0} for x in range(6)]
    message = {**MARKER, "type": kind, "points": points}
    drawn = draw(ViewScene(), "/marks", "visualization_msgs/msg/Marker", message)
    assert not said(drawn)
    assert drawn["markers/marks/things/3"].frame == "map"


def test_a_marker_is_placed_by_its_pose_and_has_its_colours_to_the_byte() -> None:
    points = [{"x": float(x), "y": 0.0, "z": 0.0} for x in range(2)]
    colours = [{"r": 1.0, "g": 0.2, "b": 0.0, "a": 0.4}, {"r": 0.0, "g": 0.6, "b": 1.0, "a": 1.0}]
    message = {**MARKER, "type": 8, "points": points, "colors": colours}
    drawn = draw(ViewScene(), "/marks", "visualization_msgs/msg/Marker", message)
    shape = drawn["markers/marks/things/3"].shapes[0]
    assert arrow(shape.positions) == [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]
    assert arrow(shape.colors) == [0xFF330066, 0x0099FFFF]


def test_one_bad_marker_leaves_the_others() -> None:
    message = {"markers": [{**MARKER, "id": 1}, {**MARKER, "id": 2, "type": 42}, MARKER]}
    drawn = draw(ViewScene(), "/marks", "visualization_msgs/msg/MarkerArray", message)
    assert {"markers/marks/things/1", "markers/marks/things/3"} <= drawn.keys()
    assert "there is no shape for markers of type 42" in said(drawn)


def test_a_marker_can_be_removed() -> None:
    message = {**MARKER, "action": 2}
    drawn = draw(ViewScene(), "/marks", "visualization_msgs/msg/Marker", message)
    assert drawn["markers/marks/things/3"].recursive


def test_a_marker_is_removed_when_its_lifetime_is_over() -> None:
    scene, kind = ViewScene(), "visualization_msgs/msg/MarkerArray"
    seconds = {1: 1, 2: 2**31 - 1, 3: 0, 4: 1}
    markers = [
        {**MARKER, "id": i, "lifetime": {"sec": s, "nanosec": 0}} for i, s in seconds.items()
    ]
    drawn = draw(scene, "/marks", kind, {"markers": markers}, {"markers": [{**MARKER, "id": 4}]})
    assert len([one for one in drawn.values() if one.shapes and one.path[0] == "markers"]) == 4
    later = draw(scene, "/marks", kind)
    assert [path for path, one in later.items() if one.recursive] == ["markers/marks/things/1"]
    assert not draw(scene, "/marks", kind)


def test_the_robot_is_drawn_link_by_link() -> None:
    text = """<robot name="r"><link name="base"><visual><geometry><box size="1 2 3"/></geometry>
        </visual></link></robot>"""
    scene = ViewScene()
    drawn = draw(scene, "/robot_description", "std_msgs/msg/String", {"data": text})
    assert drawn["robot/base/0"].frame == "base"
    assert arrow(drawn["robot/base/0"].shapes[0].half_sizes) == [[0.5, 1.0, 1.5]]
    words = said(draw(scene, "/robot_description", "std_msgs/msg/String", {"data": "<robot"}))
    assert words.startswith("/robot_description is not drawn: ")


def test_a_message_of_another_shape_ends_nothing() -> None:
    drawn = draw(ViewScene(), "/tf", "std_msgs/msg/String", {"data": "?"})
    assert "the message has no field transforms" in said(drawn)
