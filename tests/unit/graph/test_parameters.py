"""Parameters: their values, and their files as ROS reads and writes them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from graph.calls.parameters import TYPES, carried
from graph.calls.parameters_file import dump, load
from graph.data import ParameterRow
from graph.messages.making import FieldError
from text.yaml_faults import YamlError

TEXTS = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"))
INTEGERS = st.integers(-(2**63), 2**63 - 1)
DOUBLES = st.floats(allow_nan=False)
SINGLE: dict[str, st.SearchStrategy[Any]] = {
    "bool": st.booleans(),
    "integer": INTEGERS,
    "double": DOUBLES,
    "string": TEXTS,
}
VALUES = st.one_of(
    *(st.tuples(st.just(name), one) for name, one in SINGLE.items()),
    *(st.tuples(st.just(f"{name}_array"), st.lists(one)) for name, one in SINGLE.items()),
)
NAMES = st.lists(TEXTS.filter(lambda text: "." not in text), min_size=1).map(".".join) | TEXTS
NODES = st.lists(st.from_regex(r"[a-z_][a-z0-9_]*", fullmatch=True), min_size=1, max_size=3).map(
    lambda parts: "/" + "/".join(parts)
)


def rows(values: dict[str, tuple[str, Any]]) -> list[ParameterRow]:
    return [ParameterRow(name, kind, value) for name, (kind, value) in values.items()]


@given(NODES, st.dictionaries(NAMES, VALUES))
def test_what_is_written_is_read_again(node: str, values: dict[str, tuple[str, Any]]) -> None:
    found = load(dump(node, rows(values)), node)
    assert found == {name: value for name, (_, value) in values.items()}
    for name, (kind, value) in values.items():
        if value != []:
            assert carried("not_set", found[name])["type"] == TYPES.index(kind)
        assert carried(kind, found[name])[f"{kind}_value"] == value


@given(st.dictionaries(NAMES, VALUES, min_size=1))
def test_pyyaml_reads_the_same_nested_by_dots(values: dict[str, tuple[str, Any]]) -> None:
    def flat(tree: dict[str, Any], prefix: str) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for key, value in tree.items():
            nested = isinstance(value, dict)
            found |= flat(value, f"{prefix}{key}.") if nested else {f"{prefix}{key}": value}
        return found

    tree = yaml.safe_load(dump("/robot", rows(values)))
    assert flat(tree["/robot"]["ros__parameters"], "") == {n: v for n, (_, v) in values.items()}


@pytest.mark.parametrize(
    ("node", "expected"),
    [("/robot", {"a": 1, "b": 2}), ("/arm/robot", {"a": 3, "c": 4}), ("/arm/left/hand", {"a": 1, "d": 5})],
)
def test_wildcards_and_nested_namespaces_are_those_of_ros(node: str, expected: dict[str, int]) -> None:
    text = """\
/**:
  ros__parameters: {a: 1}
robot:
  ros__parameters: {b: 2}
arm:
  robot:
    ros__parameters: {a: 3, c: 4}
  "*":
    hand:
      ros__parameters: {d: 5}
"""
    assert load(text, node) == expected


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("", 1, "the file is empty"),
        ("# nothing\n", 1, "the file is empty"),
        ("/robot:\n  speed: 1\n", 2, "expected `ros__parameters:` under the name of a node"),
        ("ros__parameters:\n  a: 1\n", 1, "is not under any node"),
        ("/robot:\n  ros__parameters:\n    - a\n", 3, "expected `name: value`, found a list"),
        ("/robot:\n  ros__parameters:\n    a:\n", 3, "'a' has no value"),
        ("/robot:\n  ros__parameters:\n    a: [1, [2]]\n", 3, "expected a single value"),
        ("/robot:\n  ros__parameters:\n    a:\n      - 1\n      - x: 2\n", 5, "a single value"),
        ("/robot:\n  ros__parameters:\n    a: [1, two]\n", 3, "different types"),
        ("/robot:\n  ros__parameters:\n    a: [1, 2\n", 3, "not closed"),
        ("/robot:\n  ros__parameters:\n\t a: 1\n", 3, "tab"),
        ("/robot:\n  ros__parameters:\n    a: &x 1\n    b: *x\n", 3, "anchors"),
        ("/other:\n  ros__parameters:\n    a: 1\n", 1, "nothing for /robot; it is for /other"),
        ("- a\n", 1, "found a list"),
        ("a: 1\n", 1, "expected `ros__parameters:`"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(text: str, line: int, words: str) -> None:
    with pytest.raises(YamlError) as caught:
        load(text, "/robot")
    assert words in caught.value.message
    assert caught.value.line == line


@pytest.mark.parametrize(
    ("kind", "value", "made"),
    [
        ("double", 2, 2.0), ("double", " 1e3 ", 1000.0), ("double", "-.inf", float("-inf")),
        ("double", "0x10", 16.0), ("double", "017", 15.0), ("double", "Inf", float("inf")),
        ("integer", "0x10", 16), ("integer", "017", 15), ("integer", "0o17", 15),
        ("integer", "1e3", 1000), ("integer", " -1_000 ", -1000), ("integer", 3.0, 3),
        ("bool", "Yes", True), ("bool", False, False), ("string", "5", "5"), ("string", "", ""),
        ("double_array", "[1, 2.5]", [1.0, 2.5]), ("double_array", [], []),
        ("integer_array", np.array([1, 2]), [1, 2]), ("string_array", "[a, 'b c']", ["a", "b c"]),
        ("bool_array", [True, "off"], [True, False]), ("byte_array", [0, 255], b"\x00\xff"),
        ("byte_array", b"ab", b"ab"),
    ],
)  # fmt: skip
def test_what_fits_a_type_is_taken(kind: str, value: Any, made: Any) -> None:
    tree = carried(kind, value)
    assert tree == {"type": TYPES.index(kind), f"{kind}_value": made}
    assert type(tree[f"{kind}_value"]) is type(made)


@pytest.mark.parametrize(
    ("kind", "value", "words"),
    [
        ("double", "fast", "expected a number, got 'fast'"),
        ("double", "0,5", "write a fraction with a point: 0.5"),
        ("double", True, "expected a number, got True"),
        ("double", [1.0], "expected a number"),
        ("double", "1e400", "expected a number, got '1e400'"),
        ("double", "true", "expected a number, got 'true'"),
        ("double", "", "expected a number, got ''"),
        ("double", 10**400, "is too large for a double"),
        ("integer", 1.5, "expected a whole number, got 1.5"),
        ("integer", "1.5", "expected a whole number"),
        ("integer", float("inf"), "expected a whole number, got inf"),
        ("integer", "on", "expected a whole number, got 'on'"),
        ("integer", "~", "expected a whole number, got '~'"),
        ("integer", "inf", "expected a whole number, got inf"),
        ("integer", "٣", "expected a whole number"),
        ("integer", 2**63, "expected -9223372036854775808 to 9223372036854775807"),
        ("bool", 1, "expected true or false, got 1"),
        ("bool", "maybe", "expected true or false"),
        ("bool", "1", "expected true or false, got '1'"),
        ("string", 5, "expected a string, got 5: put it in quotes"),
        ("string", None, "expected a string, got nothing"),
        ("string", "a\0b", "NUL"),
        ("string", "\ud800", "not valid Unicode"),
        ("string_array", "abc", "expected a list, such as [1, 2], got 'abc'"),
        ("double_array", "[1, x]", "expected a number, got 'x'"),
        ("double_array", "[1, ", "a value is missing here"),
        ("byte_array", [256], "expected 0 to 255"),
        ("not_set", [], "has no type"),
        ("not_set", [1, "a"], "one type"),
        ("not_set", [[1]], "one type"),
        ("not_set", {}, "expected a list"),
    ],
)
def test_what_does_not_fit_is_refused_in_words(kind: str, value: Any, words: str) -> None:
    with pytest.raises(FieldError) as caught:
        carried(kind, value)
    assert words in str(caught.value)
