"""Expressions over a message: what they tell, what is refused, and where it says what is wrong."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from graph.messages.condition import ConditionError, MessageFilter

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
        "__import__('os').system('true')",
        "m.__class__.__init__",
        "().__class__.__base__",
        "open('/etc/passwd')",
        "eval('1')",
        "m.text.upper()",
        "m.get('x')",
        "[x for x in m.ranges]",
        "(lambda: 1)()",
        "f'{m}'",
        "9 ** 9 ** 9",
        "1 << 99999",
        "'a' * 999999999",
        "(x := 5)",
        "m.speed if m.ok else 0",
        "len(*m.names)",
        "m.names[0:1]",
        "{m.speed: 1}",
        "b'a'",
        "...",
        "None",
        "1j",
        "m.ok is True",
        "~m.count",
        "await m",
        "m.speed; 1",
        "m.speed\n1",
    ],
)
def test_nothing_else_of_python_is_understood(text: str) -> None:
    with pytest.raises(ConditionError):
        MessageFilter(text).holds(SCAN)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("m.sped > 0", "column 1: m.sped: no such field; did you mean speed?"),
        (
            "m.ok and m.header.stamp.zzz",
            "column 10: m.header.stamp.zzz: no such field; there is",
        ),
        ("m.speed.x > 0", "column 1: m.speed.x: a number has no fields"),
        ("m.points.x > 0", "m.points.x: a list has no fields"),
        ("m.ranges[3] > 0", "column 1: m.ranges[3]: there are 3 elements, counted from 0"),
        ("m.ranges['a']", "the index of an element must be a whole number"),
        ("m.header[0]", "a message has no elements"),
        (
            "m.ranges > 1",
            "column 1: m.ranges > 1: a list and a number cannot be compared like this",
        ),
        ("m.text < 5", "a string and a number cannot be compared like this"),
        ("m.ranges", "column 1: m.ranges: it is a list, which is neither true nor false"),
        ("m.header == 1", "compare one of the fields of a message"),
        ("m.text + 1 > 2", "column 1: m.text: a string is not a number"),
        ("m.count / (m.count - 3)", "division by zero"),
        ("min(m.empty) > 0", "column 5: m.empty: it is empty"),
        ("max(m.names) > 0", "column 5: m.names: max takes a list of numbers"),
        ("len(m.speed) > 0", "column 5: m.speed: a number has no elements"),
        ("5 in m.speed", "a number cannot be in a number"),
        ("5 in m.text", "a number cannot be in a string"),
        ("1.0 * " + "9" * 400 + " > 0", "the number is too large"),
    ],
)
def test_what_a_message_cannot_answer_is_told_with_its_place(text: str, told: str) -> None:
    condition = MessageFilter(text)
    with pytest.raises(ConditionError) as error:
        condition.holds(SCAN)
    assert told in str(error.value)
