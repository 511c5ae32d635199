"""The message types are those of ROS 2 to the letter.

Peers compare types by their hash (REP 2011), so the hashes are written out here; they are those
that `ros2 topic info --verbose` shows of ROS 2 Jazzy's own packages.
"""

from __future__ import annotations

import json
import os
import sys
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from ackermann_msgs.msg import AckermannDrive, AckermannDriveStamped
from composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
from deck_interfaces.action import DriveToPoint
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from tf2_msgs.msg import TFMessage

from graph.messages.types import load_message
from tests.ros.graph.type_hashes import NOTHING, Fields, type_hash, with_service
from tests.ros.peer import Peer
from tests.waiting import wait_until

HASHES = {
    "ackermann_msgs/msg/AckermannDrive": (
        "RIHS01_acf287a224a947dd1b0b87d6d76cdb73f497b0237b8fc73be2173b2ebbb82c99"
    ),
    "ackermann_msgs/msg/AckermannDriveStamped": (
        "RIHS01_48ca7612a08d3bb72744fd98b71b7cf2ea24c6ad50fa4e1aa0bbad963c90d8cf"
    ),
    "example_interfaces/srv/AddTwoInts": (
        "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
    ),
    "example_interfaces/action/Fibonacci": (
        "RIHS01_9508051da1ea4658de144b09bd0690ff3de52104683d847aed764d2915906f51"
    ),
    "tf2_msgs/msg/TFMessage": (
        "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"
    ),
}

NUMBERS = {
    "Byte": "byte",
    "Float32": "float32",
    "Float64": "float64",
    "Int8": "int8",
    "Int16": "int16",
    "Int32": "int32",
    "Int64": "int64",
    "UInt8": "uint8",
    "UInt16": "uint16",
    "UInt32": "uint32",
    "UInt64": "uint64",
}
"""Those with an array as well."""
WORDS = {"Bool": "bool", "Char": "char", "String": "string", "WString": "wstring"}
LAYOUT, DIMENSION = (f"example_interfaces/msg/MultiArray{part}" for part in ("Layout", "Dimension"))
EXAMPLES: dict[str, Fields] = {
    "example_interfaces/msg/Empty": NOTHING,
    DIMENSION: (("label", "string"), ("size", "uint32"), ("stride", "uint32")),
    LAYOUT: (("dim", f"{DIMENSION}[]"), ("data_offset", "uint32")),
    **{
        f"example_interfaces/msg/{name}": (("data", of),)
        for name, of in {**NUMBERS, **WORDS}.items()
    },
    **{
        f"example_interfaces/msg/{name}MultiArray": (("layout", LAYOUT), ("data", f"{of}[]"))
        for name, of in NUMBERS.items()
    },
}
"""All messages of example_interfaces, as ROS 2 defines them."""
ANSWERED: Fields = (("success", "bool"), ("message", "string"))
EXAMPLE_SERVICES: dict[str, tuple[Fields, Fields]] = {
    "example_interfaces/srv/AddTwoInts": ((("a", "int64"), ("b", "int64")), (("sum", "int64"),)),
    "example_interfaces/srv/SetBool": ((("data", "bool"),), ANSWERED),
    "example_interfaces/srv/Trigger": ((), ANSWERED),
}

FIELDS = {
    AckermannDrive: {
        "steering_angle": "float",
        "steering_angle_velocity": "float",
        "speed": "float",
        "acceleration": "float",
        "jerk": "float",
    },
    AckermannDriveStamped: {
        "header": "std_msgs/Header",
        "drive": "ackermann_msgs/AckermannDrive",
    },
    ListNodes.Request: {},
    ListNodes.Response: {
        "full_node_names": "sequence<string>",
        "unique_ids": "sequence<uint64>",
    },
    LoadNode.Request: {
        "package_name": "string",
        "plugin_name": "string",
        "node_name": "string",
        "node_namespace": "string",
        "log_level": "uint8",
        "remap_rules": "sequence<string>",
        "parameters": "sequence<rcl_interfaces/Parameter>",
        "extra_arguments": "sequence<rcl_interfaces/Parameter>",
    },
    LoadNode.Response: {
        "success": "boolean",
        "error_message": "string",
        "full_node_name": "string",
        "unique_id": "uint64",
    },
    UnloadNode.Request: {"unique_id": "uint64"},
    UnloadNode.Response: {"success": "boolean", "error_message": "string"},
    AddTwoInts.Request: {"a": "int64", "b": "int64"},
    AddTwoInts.Response: {"sum": "int64"},
    Fibonacci.Goal: {"order": "int32"},
    Fibonacci.Result: {"sequence": "sequence<int32>"},
    Fibonacci.Feedback: {"sequence": "sequence<int32>"},
    TFMessage: {"transforms": "sequence<geometry_msgs/TransformStamped>"},
    DriveToPoint.Goal: {"x": "double", "y": "double", "tolerance": "double"},
    DriveToPoint.Result: {"reached": "boolean", "distance": "double", "message": "string"},
    DriveToPoint.Feedback: {"distance": "double"},
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


def test_a_hash_is_what_the_fields_make_it() -> None:
    """The one that is known from ROS shows that the others are made as ROS makes them."""
    name = "example_interfaces/srv/AddTwoInts"
    assert type_hash(name, with_service(name, *EXAMPLE_SERVICES[name])) == HASHES[name]


@pytest.mark.parametrize("name", EXAMPLE_SERVICES)
def test_an_example_service_has_the_hash_of_its_definition(name: str) -> None:
    types = with_service(name, *EXAMPLE_SERVICES[name])
    hashes = {each["type_name"]: each["hash_string"] for each in described(name)["type_hashes"]}
    assert hashes == {each: type_hash(each, types) for each in types}


def test_example_messages_are_announced_by_the_hash_of_their_definition(peer: Peer) -> None:
    announced = {}
    for name in EXAMPLES:
        topic = "/" + name.rpartition("/")[2].lower()
        peer.publisher(topic, load_message(name))
        wait_until(partial(peer.node.count_publishers, topic), topic, 30)
        (info,) = peer.node.get_publishers_info_by_topic(topic)
        announced[info.topic_type] = str(info.topic_type_hash)
    assert announced == {name: type_hash(name, EXAMPLES) for name in EXAMPLES}


def test_no_example_is_left_out() -> None:
    folder = Path(__file__).parents[3] / "interfaces" / "example_interfaces"
    found = {str(file.relative_to(folder.parent).with_suffix("")) for file in folder.glob("*/*")}
    assert found == {*EXAMPLES, *EXAMPLE_SERVICES, "example_interfaces/action/Fibonacci"}


@pytest.mark.parametrize("kind", FIELDS, ids=lambda kind: kind.__name__)
def test_a_type_has_these_fields_and_no_others(kind: Any) -> None:
    fields = kind.get_fields_and_field_types()
    assert {name: of for name, of in fields.items() if not name.startswith("_")} == FIELDS[kind]
