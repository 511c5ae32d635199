"""Messages as YAML and back, their fields, conditions on them, and types that are missing."""

from __future__ import annotations

import math
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from graph.distro import distro
from graph.messages.condition import ConditionError, MessageFilter
from graph.messages.fields import FieldType, parse
from graph.messages.types import UnknownTypeError, load_message, load_service
from graph.messages.yaml_text import is_cut, read_message, to_yaml
from text.yaml_faults import YamlError
from text.yaml_tree import plain

TREE: dict[str, Any] = {
    "header": {"stamp": {"sec": 17, "nanosec": 250_000_000}, "frame_id": "base_link"},
    "name": ["left wheel", "on", "1e3", " b", "x: y", "вперёд", "", "nan", "# c", "-", "a,b"],
    "velocity": np.array([7.5, -11.25, math.inf, 1e-5, 1e30]),
    "short": np.array([0.1, 0.2], dtype=np.float32),
    "data": b"\x01\xff",
    "points": [{"x": 1.0, "y": 2.0}, {"x": -math.inf, "y": -0.0}, {}],
    "nothing": {},
    "none": [],
    "on": True,
}


def test_a_message_is_written_as_ros2_topic_echo_does() -> None:
    assert to_yaml(TREE) == (
        "header:\n"
        "  stamp:\n"
        "    sec: 17\n"
        "    nanosec: 250000000\n"
        "  frame_id: base_link\n"
        'name: [left wheel, "on", "1e3", " b", "x: y", вперёд, "", "nan", "# c", "-", "a,b"]\n'
        "velocity: [7.5, -11.25, .inf, 1.0e-05, 1.0e+30]\n"
        "short: [0.1, 0.2]\n"
        "data: [1, 255]\n"
        "points:\n"
        "- x: 1.0\n"
        "  y: 2.0\n"
        "- x: -.inf\n"
        "  y: -0.0\n"
        "- {}\n"
        "nothing: {}\n"
        "none: []\n"
        '"on": true\n'
    )


def test_ros2_topic_pub_reads_the_same_of_it() -> None:
    assert yaml.safe_load(to_yaml(TREE)) == plain(read_message(to_yaml(TREE)))


def test_long_arrays_are_cut_and_tell_their_length() -> None:
    tree: dict[str, Any] = {"data": bytes(921_600), "points": [{"x": 0.0}] * 3, "text": "a" * 100_000}
    text = to_yaml(tree, most=2)
    assert "data: [0, 0]  # the first 2 of 921600 elements" in text
    assert "points:  # the first 2 of 3 elements\n- x: 0.0\n- x: 0.0\n" in text
    assert "# the first 65536 of 100000 characters" in text
    assert plain(read_message(text))["points"] == [{"x": 0.0}] * 2
    assert is_cut(tree, 2)
    assert not is_cut({"points": [{"x": b"12"}]}, 2)
    assert is_cut({"points": [{"x": b"123"}]}, 2)


@pytest.mark.parametrize(
    ("text", "line", "column", "words"),
    [
        ("", 1, 1, "is empty: write {} for a message with nothing but defaults"),
        ("~", 1, 1, "is empty: write {}"),
        ("[1]", 1, 1, "expected `name: value`, found a list"),
        ("a: &x 1", 1, 4, "anchors and aliases are refused"),
        ("a: " + "[" * 100 + "]" * 100, 1, 67, "is nested deeper than 64 levels"),
        ("a: " + "я" * 600_000, 1, 1, "is longer than 1024 KiB"),
    ],
)
def test_what_is_no_message_is_refused(text: str, line: int, column: int, words: str) -> None:
    with pytest.raises(YamlError) as raised:
        read_message(text)
    assert words in raised.value.message
    assert (raised.value.line, raised.value.column) == (line, column)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.text(st.characters(codec="utf-8"), max_size=30) | st.text("onyes1.e0-_: #", max_size=6))
def test_any_text_stays_the_text_for_deck_and_for_ros2(text: str) -> None:
    written = to_yaml({"a": text, "b": [text]})
    assert plain(read_message(written)) == {"a": text, "b": [text]}
    assert yaml.safe_load(written) == {"a": text, "b": [text]}


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("double", FieldType("double")),
        ("string<10>", FieldType("string", text_limit=10)),
        ("std_msgs/Header", FieldType("std_msgs/Header")),
        ("uint8[16]", FieldType("uint8", is_many=True, size=16)),
        ("sequence<octet>", FieldType("octet", is_many=True)),
        ("sequence<uint8, 16>", FieldType("uint8", is_many=True, limit=16)),
        ("sequence<wstring<3>, 5>", FieldType("wstring", is_many=True, limit=5, text_limit=3)),
        ("sequence<string<3>>", FieldType("string", is_many=True, text_limit=3)),
        ("string<4>[2]", FieldType("string", is_many=True, size=2, text_limit=4)),
        ("geometry_msgs/Point[8]", FieldType("geometry_msgs/Point", is_many=True, size=8)),
        ("sequence<geometry_msgs/Point>", FieldType("geometry_msgs/Point", is_many=True)),
    ],
)
def test_every_form_is_understood(text: str, kind: FieldType) -> None:
    assert parse(text) == kind
    assert kind.is_message == ("/" in text)


SCAN: dict[str, Any] = {
    "header": {"stamp": {"sec": 12, "nanosec": 500}, "frame_id": "laser"},
    "ranges": np.array([0.5, 1.5, math.inf], np.float32),
    "ticks": np.array([250, 10], np.uint8),
    "empty": np.array([], np.float32),
    "picture": bytes([1, 2, 255]),
    "names": ["left", "right"],
    "points": [{"x": 1.0}, {"x": -2.5}],
    "speed": -0.25,
    "count": 3,
    "ok": True,
    "text": "вперёд",
}


@pytest.mark.parametrize(
    ("text", "fits"),
    [
        ("m.speed < 0", True),
        ("m.speed > 0.5", False),
        ("abs(m.speed) <= 0.25", True),
        ("  m.count == 3  ", True),
        ("m.ok", True),
        ("not m.ok", False),
        ("m.ok == true and m.ok != False", True),
        ("m.header.stamp.sec >= 12 and m.header.frame_id == 'laser'", True),
        ("m.header.frame_id in ('base', 'laser')", True),
        ("'las' in m.header.frame_id", True),
        ("m.text == 'вперёд'", True),
        ("m.ranges[0] < 1 < m.ranges[1]", True),
        ("m.ranges[-1] == inf", True),
        ("min(m.ranges) < 0.6 and max(m.ranges) == inf", True),
        ("len(m.ranges) == 3 and len(m.empty) == 0", True),
        ("1.5 in m.ranges and 7 not in m.ranges", True),
        # As numbers, not as bytes that wrap around.
        ("m.ticks[0] + m.ticks[1] == 260", True),
        ("sum(m.ticks) == 260", True),
        ("m.ticks == [250, 10]", True),
        ("255 in m.picture and m.picture[0] == 1", True),
        ("'right' in m.names and m.names[1] == 'right'", True),
        ("m.points[1].x / 2 < -1", True),
        ("m.count % 2 == 1 or m.nowhere", True),
        ("m.count // 2 * 2 - 1 == 1", True),
        ("nan == nan", False),
        ("m.empty == []", True),
        ("9" * 400 + " in m.ranges", False),
        ("sum(m.ranges) == inf", True),
        ("m.count - 3", False),
    ],
)
def test_an_expression_holds_or_does_not(text: str, fits: bool) -> None:
    assert MessageFilter(text).holds(SCAN) is fits


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "column 1: cannot be parsed from here on"),
        ("m.speed >", "column 10: cannot be parsed from here on"),
        ("m.speed = 1", "write == to compare"),
        ("m.speed > 0 and speed < 2", "column 17: speed: the message is called m: write m.speed"),
        ("'д' in m.text or x", "column 18: x: the message is called m: write m.x"),
        ("  data > 0", "column 3: data: the message is called m: write m.data"),
        ("len", "column 1: len: it is a function: write len(…)"),
        ("len(m.a, m.b)", "column 1: len(m.a, m.b): len takes one value in its brackets"),
        ("len(x=1)", "column 1: len(x=1): len takes one value in its brackets"),
        ("1" * 501, "column 501: 500 characters at most"),
        ("(" * 300, "column"),
        ("-" * 400 + "1", "column"),
        ("not " * 41 + "1", "too many nested brackets"),
    ],
)
def test_what_is_no_expression_is_told_with_its_place(text: str, told: str) -> None:
    with pytest.raises(ConditionError) as error:
        MessageFilter(text)
    assert told in str(error.value)


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os').system('true')", "m.__class__.__init__", "().__class__.__base__",
        "open('/etc/passwd')", "eval('1')", "m.text.upper()", "m.get('x')", "[x for x in m.ranges]",
        "(lambda: 1)()", "f'{m}'", "9 ** 9 ** 9", "1 << 99999", "'a' * 999999999", "(x := 5)",
        "m.speed if m.ok else 0", "len(*m.names)", "m.names[0:1]", "{m.speed: 1}", "b'a'", "...",
        "None", "1j", "m.ok is True", "~m.count", "await m", "m.speed; 1", "m.speed\n1",
    ],
)  # fmt: skip
def test_nothing_else_of_python_is_understood(text: str) -> None:
    with pytest.raises(ConditionError):
        MessageFilter(text).holds(SCAN)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("m.sped > 0", "column 1: m.sped: no such field; did you mean speed?"),
        ("m.ok and m.header.stamp.zzz", "column 10: m.header.stamp.zzz: no such field; there is"),
        ("m.speed.x > 0", "column 1: m.speed.x: only a message has fields"),
        ("m.points.x > 0", "m.points.x: only a message has fields"),
        ("m.ranges[3] > 0", "column 1: m.ranges[3]: list index out of range"),
        ("m.header[0]", "a message has no elements"),
        ("m.ok and m.ranges > 1", "column 10: m.ranges > 1: '>' not supported between instances of 'list' and 'int'"),
        ("m.text + 1 > 2", "column 1: m.text: it is not a number"),
        ("m.count / (m.count - 3)", "column 1: m.count / (m.count - 3): division by zero"),
        ("abs(m.text) > 0", "column 1: abs(m.text): bad operand type"),
        ("1.0 * " + "9" * 400 + " > 0", "int too large to convert to float"),
    ],
)
def test_what_a_message_cannot_answer_is_told_with_its_place(text: str, told: str) -> None:
    condition = MessageFilter(text)
    with pytest.raises(ConditionError) as error:
        condition.holds(SCAN)
    assert told in str(error.value)


def test_a_missing_package_is_told_with_its_names_and_a_missing_type_without() -> None:
    with pytest.raises(UnknownTypeError, match=f"'apt install ros-{distro()}-foo-msgs'") as found:
        load_message("foo_msgs/msg/Bar")
    assert f"'pixi add ros-{distro()}-foo-msgs'" in str(found.value)
    assert "pip install" not in str(found.value)
    with pytest.raises(UnknownTypeError, match="without msg/Flot32; did you mean") as found:
        load_message("std_msgs/msg/Flot32")
    assert "apt install" not in str(found.value)


class HalfLoaded(type):
    """Has its own type support at once, and that of what is inside it only later."""

    _TYPE_SUPPORT: object = None
    inner: object = None
    begun, looked_at = threading.Event(), threading.Event()

    def __import_type_support__(cls) -> None:
        HalfLoaded._TYPE_SUPPORT = object()
        HalfLoaded.begun.set()
        # Long enough for the other thread to take what is there; with a lock it cannot.
        HalfLoaded.looked_at.wait(0.3)
        HalfLoaded.inner = object()


def test_a_type_that_another_thread_is_loading_is_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("half_msgs", "half_msgs.msg", "half_msgs.srv"):
        module: Any = ModuleType(name)
        module.Thing = HalfLoaded("Thing", (), {})
        monkeypatch.setitem(sys.modules, name, module)
    thing = sys.modules["half_msgs.msg"].Thing
    monkeypatch.setattr(sys.modules["half_msgs.srv"], "Thing", thing)

    def second() -> object:
        assert HalfLoaded.begun.wait(5)
        found: Any = load_service("half_msgs/srv/Thing")
        HalfLoaded.looked_at.set()
        return found.inner

    with ThreadPoolExecutor(2) as pool:
        inner = pool.submit(second)
        pool.submit(load_message, "half_msgs/msg/Thing").result(5)
        assert inner.result(5) is not None
