"""Messages as YAML and back."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from graph.messages.yaml_reading import read_message
from graph.messages.yaml_text import is_cut, to_yaml
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
    tree: dict[str, Any] = {
        "data": bytes(921_600),
        "points": [{"x": 0.0}] * 3,
        "text": "a" * 100_000,
    }
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
        ("a: &x 1", 1, 4, "anchors are refused"),
        ("a: " + "[" * 100, 1, 67, "is nested deeper than 64 levels"),
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
