"""Every installed message, service and action as YAML and back: it is the same message."""

from __future__ import annotations

from typing import Any

import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rclpy.serialization import deserialize_message, serialize_message

from graph.messages.browse import interfaces
from graph.messages.dated import draft
from graph.messages.making import FieldError, to_message
from graph.messages.types import UnknownTypeError
from graph.messages.values import to_tree
from graph.messages.yaml_form import check, prefilled
from graph.messages.yaml_reading import read_message
from graph.messages.yaml_text import to_yaml
from tests.ros.any_message import parts_of, same, trees_of
from text.yaml_faults import YamlError
from text.yaml_tree import plain

pytestmark = pytest.mark.nightly

TYPES = interfaces()
PARTS = [part for name in TYPES for part in parts_of(name)]


def test_all_three_kinds_are_tried() -> None:
    names = {name.split("/")[1].partition(".")[0] for name, _cls in PARTS}
    assert names == {"msg", "srv", "action"}
    assert len(PARTS) > 180


@pytest.mark.parametrize("part", PARTS, ids=[name for name, _cls in PARTS])
@settings(max_examples=3, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
@given(data=st.data())
def test_a_message_survives_yaml(part: tuple[str, type[Any]], data: st.DataObject) -> None:
    _name, cls = part
    message = to_message(cls, data.draw(trees_of(cls)))
    raw = serialize_message(message)
    tree = to_tree(deserialize_message(raw, cls))
    text = to_yaml(tree)
    again = to_message(cls, plain(read_message(text)))
    assert same(to_tree(deserialize_message(serialize_message(again), cls)), tree)
    # What is copied here is what `ros2 topic pub` takes there.
    assert same(yaml.safe_load(text), plain(read_message(text)))


@pytest.mark.parametrize("type_name", TYPES)
def test_a_form_left_as_it_is_is_the_default_message(type_name: str) -> None:
    _name, cls = parts_of(type_name)[0]
    text = prefilled(type_name)
    assert draft(cls, check(type_name, text)).message == cls()
    assert all("  # " in line or line.endswith((":", "{}")) for line in text.splitlines())


def test_a_form_says_what_may_be_filled_in() -> None:
    assert prefilled("ackermann_msgs/msg/AckermannDriveStamped") == (
        "header:\n"
        "  stamp: now  # builtin_interfaces/Time\n"
        '  frame_id: ""  # string\n'
        "drive:\n"
        "  steering_angle: 0.0  # float32\n"
        "  steering_angle_velocity: 0.0  # float32\n"
        "  speed: 0.0  # float32\n"
        "  acceleration: 0.0  # float32\n"
        "  jerk: 0.0  # float32\n"
    )
    assert prefilled("std_msgs/msg/Empty") == "{}\n"
    polygon = prefilled("geometry_msgs/msg/Polygon")
    assert polygon == "points: []  # geometry_msgs/Point32[] of {x, y, z}\n"
    assert prefilled("example_interfaces/srv/AddTwoInts") == "a: 0  # int64\nb: 0  # int64\n"
    assert prefilled("deck_interfaces/action/DriveToPoint").startswith("x: 0.0  # float64\n")
    assert 'nested_type_name: ""  # string<=255\n' in prefilled(
        "type_description_interfaces/msg/FieldType"
    )


@pytest.mark.parametrize(
    ("type_name", "text", "line", "column", "words"),
    [
        ("std_msgs/msg/String", "\n\ndata: on", 3, 7, "got True: put it in quotes"),
        ("std_msgs/msg/Header", "stamp:\n  sec: a", 2, 8, "stamp.sec: expected a whole number"),
        ("std_msgs/msg/Header", "stamp:\n  sce: 1", 2, 3, "did you mean sec?"),
        ("geometry_msgs/msg/Polygon", "points:\n- x: 1\n- {y: b}", 3, 7, "points[1].y: expected"),
        ("geometry_msgs/msg/Polygon", "points:\n- x: 1\n- 5", 3, 3, "points[1]: expected fields"),
        ("sensor_msgs/msg/CameraInfo", "width: 1\nk:\n- 1", 2, 1, "k: expected 9 elements, got 1"),
        ("std_msgs/msg/Bool", "da.ta:\n  x: 1", 1, 1, "da.ta: no such field"),
        ("example_interfaces/srv/AddTwoInts", "a: 1\nb: 1.5", 2, 4, "b: expected a whole number"),
        ("geometry_msgs/msg/Vector3", "{y: 1, x: 0,05}", 1, 11, "x: write a fraction with a point"),
        ("geometry_msgs/msg/Vector3", "{y: 1, 5: 2}", 1, 8, "5: no such field; there is x, y, z"),
        ("deck_interfaces/action/DriveToPoint", "x: y", 1, 4, "x: expected a number, got 'y'"),
    ],
)
def test_what_does_not_fit_is_named_with_its_line(
    type_name: str, text: str, line: int, column: int, words: str
) -> None:
    with pytest.raises(FieldError) as raised:
        check(type_name, text)
    assert words in str(raised.value)
    assert (raised.value.line, raised.value.column) == (line, column)


def test_what_is_no_yaml_and_what_is_no_type_is_told() -> None:
    with pytest.raises(YamlError):
        check("std_msgs/msg/String", "data: [")
    for name in ("std_msgs/msg/Nope", "std_msgs/String", "nope", "x/srv/Y", "x/action/Y"):
        with pytest.raises(UnknownTypeError):
            prefilled(name)
