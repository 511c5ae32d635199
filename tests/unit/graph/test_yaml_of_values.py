"""Messages as YAML and back; what a word of YAML means; what is refused, and where."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from graph.messages.yaml_text import YamlError, from_yaml, is_cut, to_yaml

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
    assert yaml.safe_load(to_yaml(TREE)) == from_yaml(to_yaml(TREE))


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
    assert from_yaml(text)["points"] == [{"x": 0.0}] * 2
    assert is_cut(tree, 2)
    assert not is_cut({"points": [{"x": b"12"}]}, 2)
    assert is_cut({"points": [{"x": b"123"}]}, 2)


@pytest.mark.parametrize(
    ("word", "value"),
    [
        ("on", True),
        ("No", False),
        ("y", "y"),
        ("1e3", 1000.0),
        ("-.5e-1", -0.05),
        ("0o17", 15),
        ("017", 15),
        ("09", "09"),
        ("0x1F", 31),
        ("1_000", 1000),
        ("12:30", "12:30"),
        ("2026-01-01", "2026-01-01"),
        ("~", None),
        ("", None),
        ("inf", math.inf),
        ("-.inf", -math.inf),
        ("1e400", "1e400"),
        ("'on'", "on"),
        ('"5"', "5"),
        ("!!str 5", "5"),
        ("=", "="),
        ("<<", "<<"),
        ("9" * 2000, "9" * 2000),
    ],
)
def test_words_mean_what_a_ros_user_expects(word: str, value: object) -> None:
    read = from_yaml(f"a: {word}")["a"]
    assert read == value
    assert type(read) is type(value)


def test_nan_is_a_number() -> None:
    for word in ("nan", ".nan", "NaN"):
        assert math.isnan(from_yaml(f"a: {word}")["a"])  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("text", "line", "column", "words"),
    [
        ("", 1, 1, "is empty: write {}"),
        ("[1]", 1, 1, "found a list"),
        ("5", 1, 1, "found a single value"),
        ("a: 1\nb: 2\na: 3", 3, 1, "the field 'a' appears a second time, first on line 1"),
        ("x:\n  {a: 1, a: 2}", 2, 10, "second time, first on line 2"),
        ("a: &x 1", 1, 4, "anchors are refused"),
        ("a: *x", 1, 4, "aliases are refused"),
        ("a: 1\n---\nb: 2", 2, 1, "a second document"),
        ("a:\n\tb: 1", 2, 1, "this line is indented with a tab"),
        ("b: 1\na: [1, 2", 2, 4, "this list is not closed"),
        ("a: [1,\n\n", 1, 7, "a value is missing here"),
        ("a: {b: 1", 1, 4, "these braces are not closed"),
        ('a: "x\nb: 3', 1, 4, "the text in quotes is not closed"),
        ("a: b: c", 1, 5, "a second ':' in one line"),
        ("a\nb: 1", 2, 2, "does not fit the one above"),
        ("x: 1.0\ny:2.0\nz: 0.0", 2, 1, "or a space after it"),
        ("x: 1.0\ny", 2, 1, "a ':' is missing after the name of the field"),
        ("a: @x", 1, 4, "put the text in quotes"),
        ("a:\n    b: 1\n  c: 2", 3, 3, "the indentation does not fit"),
        ("a: !!python/object:os.x 1", 1, 4, "the tag !!python/object:os.x is refused"),
        ("a: b\x07", 1, 5, "the character U+0007 is not allowed"),
        ("a: \ud800", 1, 4, "the character U+D800 is not allowed"),
        ("a: " + "[" * 100, 1, 67, "is nested deeper than 64 levels"),
        ("? [a]\n: 1", 1, 3, "expected a field's name"),
        ("a: " + "я" * 600_000, 1, 1, "is longer than 1024 KiB"),
    ],
)
def test_what_is_refused_tells_its_place(text: str, line: int, column: int, words: str) -> None:
    with pytest.raises(YamlError) as raised:
        from_yaml(text)
    assert words in raised.value.message
    assert (raised.value.line, raised.value.column) == (line, column)
    assert str(raised.value) == f"{line}:{column}: {raised.value.message}"


def test_a_bomb_of_aliases_does_not_go_off() -> None:
    lines = ["a0: &a0 [x, x]"]
    lines += [f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]" for n in range(1, 40)]
    with pytest.raises(YamlError, match="anchors"):
        from_yaml("\n".join(lines))


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.text(max_size=60) | st.text("ab:-[]{}'\"#&*!|>%@`\t\n ,?0.", max_size=40))
def test_any_text_is_fields_or_an_error_with_a_place(text: str) -> None:
    place = (1, 1)
    try:
        assert isinstance(from_yaml(text), dict)
    except YamlError as error:
        place = (error.line, error.column)
    assert 1 <= place[0] <= text.count("\n") + 2
    assert place[1] >= 1


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.text(st.characters(codec="utf-8"), max_size=30) | st.text("onyes1.e0-_: #", max_size=6))
def test_any_text_stays_the_text_for_deck_and_for_ros2(text: str) -> None:
    written = to_yaml({"a": text, "b": [text]})
    assert from_yaml(written) == {"a": text, "b": [text]}
    assert yaml.safe_load(written) == {"a": text, "b": [text]}
