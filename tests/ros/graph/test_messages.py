"""Messages as trees, as the bag and the installed types have them; and the types themselves."""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rclpy
from ackermann_msgs.msg import AckermannDriveStamped
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from example_interfaces.msg import WString
from geometry_msgs.msg import PoseStamped, TransformStamped
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import ByteMultiArray, Char, ColorRGBA, Empty, Int8MultiArray
from std_msgs.msg import String as Text
from tf2_msgs.msg import TFMessage

from graph.calls.parameters_file import dump
from graph.data import ParameterRow
from graph.distro import distro
from graph.messages.browse import Constant, definition, interfaces
from graph.messages.definitions import TypeText, bag_decoder, decoder, typestore
from graph.messages.definitions import definition as bag_definition
from graph.messages.fields import to_tree
from graph.messages.making import FieldError, draft, to_message
from graph.messages.types import UnknownTypeError, load_message, load_service
from tests.ros.any_message import TEXTS, TYPES, same, trees_of


@pytest.mark.parametrize("type_name", TYPES)
def test_an_empty_message_of_every_type_survives(type_name: str) -> None:
    cls = load_message(type_name)
    message = cls()
    tree = to_tree(message)
    assert to_message(cls, tree) == message
    assert to_message(cls, {}) == message
    assert deserialize_message(serialize_message(to_message(cls, tree)), cls) == message


@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
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
        ("std_msgs/msg/Header", {"frame_idd": ""}, "frame_idd: no such field; did you mean frame_id?"),
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
        ("unique_identifier_msgs/msg/UUID", {"uuid": "short"}, "uuid: expected 16 elements, got 5"),
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
    read = decoder("sensor_msgs/msg/Image")
    assert same(read(raw), to_tree(deserialize_message(raw, cls)))
    padding = 4
    if cut >= padding:
        with pytest.raises(Exception, match="deserialize"):
            read(raw[:-cut])


@pytest.mark.parametrize(
    ("load", "name", "word"),
    [
        (load_message, "std_msgs/msg/Flot32", "did you mean std_msgs/msg/Float32?"),
        (load_message, "std_msgs/srv/Float32", "write it as package/msg/Name"),
        (load_message, "std_msgs/Float32", "write it as package/msg/Name"),
        (load_message, "os;/msg/x", "is not the name of a type"),
        (load_message, "json/msg/Thing", "package json is installed and has no messages"),
        (load_service, "std_msgs/srv/Trigger", "package std_msgs is installed and has no services"),
        (load_service, "foo_srvs/srv/Bar", f"'apt install ros-{distro()}-foo-srvs'"),
    ],
)
def test_a_type_that_cannot_be_had_says_why(load: Any, name: str, word: str) -> None:
    with pytest.raises(UnknownTypeError) as raised:
        load(name)
    assert word in str(raised.value)


def test_a_broken_package_is_an_unknown_type(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "broken_msgs" / "msg"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("raise RuntimeError('half installed')")
    (tmp_path / "broken_msgs" / "__init__.py").touch()
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(UnknownTypeError, match="cannot be used: half installed"):
        load_message("broken_msgs/msg/Thing")


# ---------------------------------------------------------------- in a bag


MESSAGES = [
    Image(height=1, width=2, encoding="rgb8", step=6, data=[1, 2, 3, 4, 5, 255]),
    JointState(name=["a", "б"], position=[0.5, -1.0], velocity=[], effort=[1e300]),
    TFMessage(transforms=[TransformStamped(child_frame_id="camera"), TransformStamped()]),
    DiagnosticArray(status=[DiagnosticStatus(level=b"\x02", name="x", values=[KeyValue(key="k", value="v")])]),
    ByteMultiArray(data=[b"\x01", b"\xff"]),
    Int8MultiArray(data=[-1, 2]),
    Odometry(child_frame_id="base_link"),
    AckermannDriveStamped(),
    ColorRGBA(r=0.25),
    Char(data=65),
    Empty(),
    Text(data="привет"),
    WString(data="wide: привет 😀"),
]


def type_of(message: Any) -> str:
    package, kind, *_ = type(message).__module__.split(".")
    return f"{package}/{kind}/{type(message).__name__}"


def plain(value: Any) -> Any:
    """Arrays as lists with the name of their element's kind."""
    if isinstance(value, np.ndarray):
        return (value.dtype.kind, value.tolist())
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    return [plain(each) for each in value] if isinstance(value, list) else value


@pytest.mark.parametrize("message", MESSAGES, ids=type_of)
def test_the_tree_is_that_of_the_live_message(message: Any) -> None:
    name = type_of(message)
    decode = bag_decoder(TypeText(name, bag_definition(name)))
    tree = decode(serialize_message(message))
    assert plain(tree) == plain(to_tree(message))
    assert list(tree) == list(to_tree(message))


@pytest.mark.parametrize("name", sorted(typestore().fielddefs))
def test_every_type_of_this_ros_is_told_to_a_bag_so_that_it_is_understood(name: str) -> None:
    bag_decoder(TypeText(name, bag_definition(name)))


IDL = "module my_msgs { module msg { struct Names { sequence<wstring<3>> names; int8 n; wstring last; }; }; };"


@pytest.mark.parametrize(
    ("text", "is_idl"),
    [
        ('wstring X="a"\nwstring<=3[] names\nint8 n\nwstring last "d"  # wstring\n', False),
        (IDL, True),
        ('wstring X="a"\r\nwstring[] names\r\nint8 n\r\nwstring last\r\n', False),
        (
            IDL.replace(
                "module msg {", 'module msg { const wstring X = L"a"; typedef sequence<wstring> wstring__many;'
            ).replace("sequence<wstring<3>> n", "wstring__many n"),
            True,
        ),
    ],
)
def test_wide_texts_are_read_with_what_is_around_them(text: str, is_idl: bool) -> None:
    """By the text of the bag: no type that is installed has them so."""
    raw = b"\0\1\0\0\2\0\0\0\1\0\0\0A\0\0\0\0\0\0\0\7\0\0\0\2\0\0\0\x3d\xd8\0\0\0\xde\0\0"
    decode = bag_decoder(TypeText("my_msgs/msg/Names", text, is_idl))
    assert decode(raw) == {"names": ["A", ""], "n": 7, "last": "😀"}


# ---------------------------------------------------------------- what is installed


HASHES = {
    "ackermann_msgs/msg/AckermannDrive": ("RIHS01_acf287a224a947dd1b0b87d6d76cdb73f497b0237b8fc73be2173b2ebbb82c99"),
    "ackermann_msgs/msg/AckermannDriveStamped": (
        "RIHS01_48ca7612a08d3bb72744fd98b71b7cf2ea24c6ad50fa4e1aa0bbad963c90d8cf"
    ),
    "example_interfaces/srv/AddTwoInts": ("RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"),
    "example_interfaces/action/Fibonacci": (
        "RIHS01_9508051da1ea4658de144b09bd0690ff3de52104683d847aed764d2915906f51"
    ),
    "tf2_msgs/msg/TFMessage": ("RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"),
}


def described(name: str) -> dict[str, Any]:
    """Return the type description that was installed with a type."""
    prefixes = [*os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep), sys.prefix]
    files = (Path(prefix) / "share" / f"{name}.json" for prefix in prefixes if prefix)
    found: dict[str, Any] = json.loads(next(file for file in files if file.is_file()).read_text())
    return found


@pytest.mark.parametrize("name", HASHES)
def test_a_type_has_the_hash_of_its_namesake_in_ros(name: str) -> None:
    hashes = {each["type_name"]: each["hash_string"] for each in described(name)["type_hashes"]}
    assert hashes[name] == HASHES[name]


def test_messages_services_and_actions_are_found() -> None:
    names = interfaces()
    assert {
        "std_msgs/msg/Float32",
        "sensor_msgs/msg/Image",
        "ackermann_msgs/msg/AckermannDriveStamped",
        "example_interfaces/srv/AddTwoInts",
        "deck_interfaces/action/DriveToPoint",
    } <= set(names)
    assert list(names) == sorted(set(names))
    assert not any("_Request" in name or "_Goal" in name for name in names)


def test_every_installed_type_has_a_definition_down_to_its_last_field() -> None:
    for name in interfaces():
        for part in definition(name).parts:
            for field in part.fields:
                assert field.message is None or definition(field.message)


def test_a_message_tells_types_bounds_defaults_and_constants() -> None:
    (part,) = definition("geometry_msgs/msg/Quaternion").parts
    assert [(f.name, f.type_name, f.default) for f in part.fields][3] == ("w", "float64", 1.0)
    (part,) = definition("sensor_msgs/msg/CameraInfo").parts
    fields = {field.name: field for field in part.fields}
    assert (fields["header"].message, fields["header"].type_name) == ("std_msgs/msg/Header", "std_msgs/Header")
    assert fields["k"].type_name == "float64[9]"
    (part,) = definition("rcl_interfaces/msg/ParameterDescriptor").parts
    bounded = next(field for field in part.fields if field.name == "integer_range")
    assert bounded.type_name == "rcl_interfaces/IntegerRange[<=1]"
    (part,) = definition("diagnostic_msgs/msg/DiagnosticStatus").parts
    assert part.constants[:2] == (Constant("OK", 0), Constant("WARN", 1))
    level = part.fields[0]
    assert (level.type_name, level.least, level.greatest) == ("byte", 0, 255)
    (part,) = definition("std_msgs/msg/Empty").parts
    assert part.fields == ()


@pytest.mark.parametrize("name", ["std_msgs/msg/Nope", "nope_msgs/msg/Bool", "std_msgs/Bool", "a/b/c", "", "x/srv/Y"])
def test_a_type_that_is_not_there_says_so(name: str) -> None:
    with pytest.raises(UnknownTypeError):
        definition(name)


# ---------------------------------------------------------------- the time of sending


def ns(stamp: Any) -> int:
    seconds: int = stamp.sec
    nanoseconds: int = stamp.nanosec
    return seconds * 1_000_000_000 + nanoseconds


@pytest.mark.parametrize("header", ["auto", {"stamp": "now"}])
def test_it_is_the_time_of_each_sending(header: Any) -> None:
    made = draft(PoseStamped, {"header": header, "pose": {"position": {"x": 1.0}}})
    last = time.time_ns()
    for _sending in range(3):
        sent = made.dated()
        assert last <= ns(sent.header.stamp) <= time.time_ns()
        assert sent.pose.position.x == 1.0
        last = ns(sent.header.stamp)


# ---------------------------------------------------------------- a file of parameters


def overrides(path: Path, domain: int) -> dict[str, Any]:
    """What a node that is run with this file gets."""
    context = Context()
    rclpy.init(context=context, domain_id=domain)
    node = rclpy.create_node(
        "robot",
        context=context,
        namespace="/arm",
        cli_args=["--ros-args", "--params-file", str(path)],
        allow_undeclared_parameters=True,
        automatically_declare_parameters_from_overrides=True,
        start_parameter_services=False,
    )
    try:
        found: dict[str, Any] = node.get_parameters_by_prefix("")
        return {name: parameter.value for name, parameter in found.items()}
    finally:
        node.destroy_node()
        context.try_shutdown()


def test_ros_reads_what_is_written(tmp_path: Path, ros_domain: int) -> None:
    values: dict[str, tuple[str, Any]] = {
        "speed": ("double", 1e16),
        "tiny": ("double", 1e-300),
        "endless": ("double", float("-inf")),
        "count": ("integer", -(2**63)),
        "on": ("bool", False),
        "frame.name": ("string", "1e5"),
        "frame.y": ("string", "y"),
        "frame.name.deep": ("string", 'quote " back \\ line\nЁж 🦔'),
        "empty": ("string", ""),
        "joints": ("string_array", ["true", "2", "[x]"]),
        "limits": ("double_array", [1.0, 1e-7]),
        "raw": ("byte_array", b"\x00"),
        "unset": ("double", None),
    }
    rows = [ParameterRow(name, kind, value) for name, (kind, value) in values.items()]
    path = tmp_path / "robot.yaml"
    path.write_text(dump("/arm/robot", rows), encoding="utf-8")
    found = overrides(path, ros_domain)
    for name, (kind, value) in values.items():
        if name in {"raw", "unset"}:
            assert name not in found
        else:
            assert (list(found[name]) if kind.endswith("array") else found[name]) == value, name
            assert isinstance(value, list) or type(found[name]) is type(value), name
