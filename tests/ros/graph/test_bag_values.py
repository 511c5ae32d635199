"""A bag's trees are those of live messages: the same rules, by the bag's own definitions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from ackermann_msgs.msg import AckermannDriveStamped
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from example_interfaces.msg import WString
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import ByteMultiArray, Char, ColorRGBA, Empty, Int8MultiArray
from std_msgs.msg import String as Text
from tf2_msgs.msg import TFMessage

from graph.bag.decoding import TypeText, bag_decoder
from graph.bag.types import definition, jazzy
from graph.messages.values import to_tree

MESSAGES = [
    Image(height=1, width=2, encoding="rgb8", step=6, data=[1, 2, 3, 4, 5, 255]),
    JointState(name=["a", "б"], position=[0.5, -1.0], velocity=[], effort=[1e300]),
    TFMessage(transforms=[TransformStamped(child_frame_id="camera"), TransformStamped()]),
    DiagnosticArray(
        status=[DiagnosticStatus(level=b"\x02", name="x", values=[KeyValue(key="k", value="v")])]
    ),
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

IDL = (
    "module my_msgs { module msg { struct Names {"
    " sequence<wstring<3>> names; int8 n; wstring last; }; }; };"
)


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
    decode = bag_decoder(TypeText(name, definition(name)))
    tree = decode(serialize_message(message))
    assert plain(tree) == plain(to_tree(message))
    assert list(tree) == list(to_tree(message))


@pytest.mark.parametrize("name", sorted(jazzy().fielddefs))
def test_every_type_of_jazzys_is_told_to_a_bag_so_that_it_is_understood(name: str) -> None:
    bag_decoder(TypeText(name, definition(name)))


@pytest.mark.parametrize(
    ("text", "is_idl"),
    [
        ('wstring X="a"\nwstring<=3[] names\nint8 n\nwstring last "d"  # wstring\n', False),
        (IDL, True),
        ('wstring X="a"\r\nwstring[] names\r\nint8 n\r\nwstring last\r\n', False),
        (
            IDL.replace(
                "module msg {",
                'module msg { const wstring X = L"a"; typedef sequence<wstring> wstring__many;',
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
