"""What a field cannot hold is refused with the field and what it can hold, and nothing is sent."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from rclpy.parameter import Parameter

from tests.ros.ros2.typed import typed

if TYPE_CHECKING:
    from tests.ros.ros2.world import World

BYTES = "std_msgs/msg/ByteMultiArray"
BOUNDED_TEXT = "type_description_interfaces/msg/IndividualTypeDescription"
BOUNDED_LIST = "shape_msgs/msg/SolidPrimitive"


@pytest.mark.parametrize(
    ("kind", "values", "why"),
    [
        ("std_msgs/msg/UInt8", "data: 300", "data: expected 0 to 255, got 300"),
        ("std_msgs/msg/UInt8", "data: -1", "data: expected 0 to 255, got -1"),
        ("std_msgs/msg/Int8", "data: -129", "data: expected -128 to 127, got -129"),
        ("std_msgs/msg/UInt16", "data: 65536", "data: expected 0 to 65535, got 65536"),
        ("std_msgs/msg/Int16", "data: 32768", "data: expected -32768 to 32767, got 32768"),
        ("std_msgs/msg/UInt32", "data: 4294967296", "data: expected 0 to 4294967295, got "),
        ("std_msgs/msg/Int32", "data: 2147483648", "data: expected -2147483648 to 2147483647"),
        ("std_msgs/msg/Int64", "data: 9223372036854775808", "data: expected -9223372036854775808"),
        ("std_msgs/msg/UInt64", "data: -1", "data: expected 0 to 18446744073709551615, got -1"),
        ("std_msgs/msg/Int32", "data: 1.7", "data: expected a whole number, got 1.7"),
        ("std_msgs/msg/Float32", "data: 1.0e39", "data: 1e+39 is too large for a float"),
        ("std_msgs/msg/Bool", "data: 'false'", "data: expected true or false, got 'false'"),
        ("std_msgs/msg/Bool", "data: 1", "data: expected true or false, got 1"),
        ("std_msgs/msg/Byte", "data: 256", "data: expected 0 to 255, got 256"),
        ("std_msgs/msg/Char", "data: -1", "data: expected 0 to 255, got -1"),
        (BYTES, "data: [{3}, {4}]", "data[0]: expected a whole number, got {'3': None}"),
        (BYTES, "data: [1, 256]", "data[1]: expected 0 to 255, got 256"),
        ("std_msgs/msg/UInt8MultiArray", "data: [1, 256]", "data[1]: expected 0 to 255, got 256"),
        ("std_msgs/msg/String", "data: {a: 1}", "data: expected a string, got {'a': 1}"),
        ("std_msgs/msg/String", '{data: "a\\0b"}', "data: a ROS string cannot hold the"),
        (
            "geometry_msgs/msg/PoseWithCovariance",
            "covariance: [1.0, 2.0]",
            "covariance: expected 36 elements, got 2",
        ),
        ("geometry_msgs/msg/Twist", "linear: {x: fast}", "linear.x: expected a number"),
        (
            "geometry_msgs/msg/Twist",
            "linear:\n  x:0",
            "linear: a space is missing after the ':': x: 0",
        ),
        ("geometry_msgs/msg/Twist", "linear: 3", "linear: expected fields by name, got 3"),
        ("geometry_msgs/msg/Polygon", "points: [{x: 1}, {q: 1}]", "points[1].q: no such field"),
        (
            "rcl_interfaces/msg/ParameterDescriptor",
            "integer_range: [{}, {}]",
            "integer_range: expected at most 1 elements, got 2",
        ),
        ("example_interfaces/msg/WString", "data: 5", "data: expected a string, got 5"),
        ("example_interfaces/msg/WString", '{data: "a\\0b"}', "data: a ROS string cannot hold the"),
        (
            BOUNDED_TEXT,
            f"type_name: {'x' * 256}",
            "type_name: expected at most 255 characters, got",
        ),
        (
            "rmw_dds_common/msg/ParticipantEntitiesInfo",
            f"node_entities_info_seq: [{{node_name: {'x' * 257}}}]",
            "node_entities_info_seq[0].node_name: expected at most 256 characters, got 257",
        ),
        (
            BOUNDED_LIST,
            "dimensions: [1, 2, 3, 4]",
            "dimensions: expected at most 3 elements, got 4",
        ),
    ],
)
def test_a_message_is_refused(kind: str, values: str, why: str) -> None:
    refused = typed("topic", "pub", "--once", "/nobody_hears", kind, values)
    assert (refused.code, refused.out) == (1, "")
    assert refused.err.startswith(f"Failed to populate field: {why}"), refused.err


@pytest.mark.parametrize(
    ("kind", "values", "sent"),
    [
        ("example_interfaces/msg/WString", 'data: "мир 🌍"', "data='мир 🌍'"),
        (BOUNDED_TEXT, f"type_name: {'x' * 255}", f"type_name='{'x' * 255}'"),
        (BOUNDED_LIST, "dimensions: [1, 2, 3]", "dimensions=[1.0, 2.0, 3.0]"),
    ],
)
def test_what_fits_is_sent(kind: str, values: str, sent: str) -> None:
    told = typed("topic", "pub", "--once", "-w", "0", "/nobody_hears_this", kind, values)
    assert (told.code, told.err) == (0, "")
    assert sent in told.out


def test_a_request_and_a_goal_are_refused() -> None:
    call = ("service", "call", "/add", "example_interfaces/srv/AddTwoInts")
    refused = typed(*call, "{a: 9223372036854775808}")
    assert refused.err.startswith("Failed to populate field: a: expected -9223372036854775808")
    assert typed(*call, "[1, 2]").code == 1
    goal = ("action", "send_goal", "/fibonacci", "example_interfaces/action/Fibonacci")
    refused = typed(*goal, "{order: 2147483648}")
    assert (refused.code, refused.out) == (1, "")
    assert refused.err.startswith("Failed to populate message fields: order: expected -2147483648")
    assert typed(*goal, "3").err == "The passed value needs to be a dictionary in YAML format\n"


def test_a_parameter_is_refused(world: World) -> None:
    refused = typed("param", "set", "/turtle", "safe.near", "9223372036854775808")
    assert (refused.code, refused.out) == (1, "")
    assert refused.err == "safe.near: 9223372036854775808 is too large for a 64-bit integer\n"
    mixed = typed("param", "set", "/turtle", "gains", "[1.0, far]")
    assert mixed.err.startswith("gains: expected a list of values of one type")
    assert world.node.get_parameter("safe.near").value == 3
    # What is no YAML, or has no value in it, is a text.
    for text in ("a: b: c", "null", "{a: 1}", "'"):
        assert typed("param", "set", "/turtle", "name", text).out == "Set parameter successful\n"
        assert world.node.get_parameter("name").value == text
    world.node.set_parameters([Parameter("name", value="лис")])
