"""Messages to trees and back: nothing is changed, for every message type installed here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message

from graph.messages.decoding import read_image
from graph.messages.making import FieldError, to_message
from graph.messages.types import UnknownTypeError, load_message, load_service
from graph.messages.values import to_tree
from tests.ros.any_message import TEXTS, TYPES, same, trees_of

if TYPE_CHECKING:
    from pathlib import Path


def test_there_are_types_to_be_tried() -> None:
    assert len(TYPES) > 100
    assert "std_msgs/msg/ByteMultiArray" in TYPES


@pytest.mark.parametrize("type_name", TYPES)
def test_an_empty_message_of_every_type_survives(type_name: str) -> None:
    cls = load_message(type_name)
    message = cls()
    tree = to_tree(message)
    assert to_message(cls, tree) == message
    assert to_message(cls, {}) == message
    assert deserialize_message(serialize_message(to_message(cls, tree)), cls) == message


@settings(
    max_examples=150, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True
)
@given(data=st.data())
def test_any_message_survives_the_way_there_and_back(data: st.DataObject) -> None:
    type_name = data.draw(st.sampled_from(TYPES))
    cls = load_message(type_name)
    tree = data.draw(trees_of(cls))
    shown = to_tree(deserialize_message(serialize_message(to_message(cls, tree)), cls))
    assert same(tree, shown)
    again = to_tree(deserialize_message(serialize_message(to_message(cls, shown)), cls))
    assert same(tree, again)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(
    type_name=st.sampled_from([t for t in TYPES if t.startswith(("std_msgs", "sensor_msgs"))]),
    tree=st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | TEXTS | st.binary(max_size=4),
        lambda inner: (
            st.lists(inner, max_size=3)
            | st.dictionaries(st.sampled_from(["data", "header", "stamp", "sec", "x"]), inner)
        ),
        max_leaves=6,
    ),
)
def test_nothing_a_person_types_leads_to_more_than_a_field_error(type_name: str, tree: Any) -> None:
    cls = load_message(type_name)
    try:
        message = to_message(cls, {"data": tree} if hasattr(cls, "data") else tree)
    except FieldError:
        return
    serialize_message(message)


@pytest.mark.parametrize(
    ("type_name", "tree", "word"),
    [
        ("std_msgs/msg/Float32", {"data": "abc"}, "data: expected a number, got 'abc'"),
        ("std_msgs/msg/Float32", {"data": "-0,5"}, "data: write a fraction with a point: -0.5"),
        ("std_msgs/msg/Float32", {"data": True}, "data: expected a number, got True"),
        ("std_msgs/msg/Float32", {"data": 1e39}, "data: 1e+39 is too large for a float"),
        ("std_msgs/msg/Float64", {"data": 10**400}, "data: 1000"),
        ("std_msgs/msg/Bool", {"data": 1}, "data: expected true or false, got 1"),
        ("std_msgs/msg/UInt8", {"data": 256}, "data: expected 0 to 255, got 256"),
        ("std_msgs/msg/Int32", {"data": 1.5}, "data: expected a whole number, got 1.5"),
        ("std_msgs/msg/String", {"data": None}, "data: expected a string, got nothing"),
        ("std_msgs/msg/String", {"data": "a\0b"}, "data: a ROS string cannot hold"),
        ("std_msgs/msg/String", {"data": "\ud800"}, "is not valid Unicode"),
        ("std_msgs/msg/Empty", {"data": 1}, "data: it has no fields at all"),
        (
            "std_msgs/msg/Header",
            {"frame_idd": ""},
            "frame_idd: no such field; did you mean frame_id?",
        ),
        ("std_msgs/msg/Header", {"stamp": 5}, "stamp: expected fields by name, got 5"),
        ("std_msgs/msg/Header", {"stamp": {"sec": "x"}}, "stamp.sec: expected a whole number"),
        ("sensor_msgs/msg/JointState", {"name": ["a", 2]}, "name[1]: expected a string, got 2"),
        ("sensor_msgs/msg/JointState", {"position": 3}, "position: expected a list, got 3"),
        ("sensor_msgs/msg/JointState", {"name": "wheel"}, "name: expected a list, got 'wheel'"),
        ("sensor_msgs/msg/CameraInfo", {"k": [1.0]}, "k: expected 9 elements, got 1"),
        ("std_msgs/msg/ByteMultiArray", {"data": [0, 300]}, "data[1]: expected 0 to 255, got 300"),
        ("std_msgs/msg/ByteMultiArray", {"data": "\ud800"}, "data: '\\ud800' is not valid Unicode"),
        ("std_msgs/msg/Float32MultiArray", {"data": "a"}, "data: expected a list, got 'a'"),
        ("sensor_msgs/msg/CameraInfo", {"k": "123456789"}, "k: expected a list"),
        (
            "unique_identifier_msgs/msg/UUID",
            {"uuid": "short"},
            "uuid: expected 16 elements, got 5",
        ),
        (
            "diagnostic_msgs/msg/DiagnosticArray",
            {"status": [{"level": 0}, {"level": -1}]},
            "status[1].level: expected 0 to 255, got -1",
        ),
    ],
)
def test_what_does_not_fit_names_its_field(type_name: str, tree: dict[str, Any], word: str) -> None:
    with pytest.raises(FieldError) as raised:
        to_message(load_message(type_name), tree)
    assert word in str(raised.value)


def test_what_people_write_is_understood() -> None:
    """Integers for floats, lists and texts for bytes, part of the fields only."""
    assert to_message(load_message("std_msgs/msg/Float64"), {"data": 3}).data == 3.0
    assert to_message(load_message("std_msgs/msg/Int32"), {"data": 3.0}).data == 3
    sound = to_message(load_message("std_msgs/msg/ByteMultiArray"), {"data": [0, 255]})
    assert b"".join(sound.data) == b"\x00\xff"
    said = to_message(load_message("std_msgs/msg/ByteMultiArray"), {"data": "Привет"})
    assert b"".join(said.data) == "Привет".encode()
    drawn = to_message(load_message("sensor_msgs/msg/Image"), {"data": "ab"})
    assert bytes(drawn.data) == b"ab"
    image = to_message(load_message("sensor_msgs/msg/Image"), {"data": [1, 2], "width": 2})
    assert (bytes(image.data), image.width, image.height) == (b"\x01\x02", 2, 0)


@settings(max_examples=50, deadline=None, derandomize=True)
@given(tree=trees_of(load_message("sensor_msgs/msg/Image")), cut=st.integers(0, 40))
def test_pictures_are_read_the_short_way_as_by_rclpy(tree: dict[str, Any], cut: int) -> None:
    cls = load_message("sensor_msgs/msg/Image")
    raw = serialize_message(to_message(cls, tree))
    assert read_image(raw) == to_tree(deserialize_message(raw, cls))
    # Cut short, or in another byte order, it is left to rclpy.
    padding = 4
    if cut >= padding:
        assert read_image(raw[:-cut]) is None
    assert read_image(b"\x00\x00" + raw[2:]) is None


def test_trees_have_the_form_that_is_promised() -> None:
    joints = load_message("sensor_msgs/msg/JointState")(name=["l", "r"], position=[1.0, 2.0])
    tree = to_tree(joints)
    assert list(tree) == ["header", "name", "position", "velocity", "effort"]
    assert isinstance(tree["position"], np.ndarray)
    assert tree["position"].dtype == np.float64
    assert tree["name"] == ["l", "r"]
    status = load_message("diagnostic_msgs/msg/DiagnosticStatus")(level=b"\x02")
    assert to_tree(status)["level"] == 2


@pytest.mark.parametrize(
    ("load", "name", "word"),
    [
        (load_message, "std_msgs/msg/Flot32", "did you mean std_msgs/msg/Float32?"),
        (load_message, "std_msgs/srv/Float32", "write it as package/msg/Name"),
        (load_message, "std_msgs/Float32", "write it as package/msg/Name"),
        (load_message, "os;/msg/x", "is not the name of a type"),
        (load_message, "json/msg/Thing", "package json is installed and has no messages"),
        (load_service, "std_msgs/srv/Trigger", "package std_msgs is installed and has no services"),
        (load_service, "foo_srvs/srv/Bar", "'apt install ros-jazzy-foo-srvs'"),
    ],
)
def test_a_type_that_cannot_be_had_says_why(load: Any, name: str, word: str) -> None:
    with pytest.raises(UnknownTypeError) as raised:
        load(name)
    assert word in str(raised.value)


def test_a_broken_package_is_an_unknown_type(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "broken_msgs" / "msg"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("raise RuntimeError('half installed')")
    (tmp_path / "broken_msgs" / "__init__.py").touch()
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(UnknownTypeError, match="cannot be used: half installed"):
        load_message("broken_msgs/msg/Thing")
