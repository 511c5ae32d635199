"""The message types are those of ROS 2 to the letter.

Peers compare types by their hash (REP 2011), so the hashes are written out here; they are those
that `ros2 topic info --verbose` shows of ROS 2 Jazzy's own packages.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

import pytest
from ackermann_msgs.msg import AckermannDrive, AckermannDriveStamped
from composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
from deck_interfaces.action import DriveToPoint
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from tf2_msgs.msg import TFMessage

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


@pytest.mark.parametrize("kind", FIELDS, ids=lambda kind: kind.__name__)
def test_a_type_has_these_fields_and_no_others(kind: Any) -> None:
    fields = kind.get_fields_and_field_types()
    assert {name: of for name, of in fields.items() if not name.startswith("_")} == FIELDS[kind]
