"""Parameters in files: what is written is read again, and what is wrong has its line."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from graph.calls.parameters_file import dump, load, load_file, save_file
from graph.calls.parameters_values import TYPES, carried
from graph.data import ParameterRow
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


@pytest.mark.parametrize(
    "name",
    [*("a" * length for length in range(1020, 1027)), "b." + "\x01" * 300, "c" * 2000 + ".d"],
    ids=lambda name: f"{name[0]}{len(name)}",
)
def test_a_name_longer_than_yaml_takes_for_a_plain_key_is_read_again(name: str) -> None:
    values = {name: ("integer", 1), "z": ("string", "last")}
    text = dump("/node", rows(values))
    assert load(text, "/node") == {name: 1, "z": "last"}
    assert yaml.safe_load(text)["/node"]["ros__parameters"]["z"] == "last"


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


def test_it_looks_as_ros2_param_dump_has_it() -> None:
    values: dict[str, tuple[str, Any]] = {
        "wheel.radius": ("double", 0.03),
        "wheel.names": ("string_array", ["left", "y"]),
        "rate": ("integer", 5),
        "frame": ("string", "1e5"),
        "on": ("bool", True),
        "none": ("not_set", None),
        "raw": ("byte_array", b"\x00"),
    }
    assert dump("/arm/robot", rows(values)) == (
        "/arm/robot:\n"
        "  ros__parameters:\n"
        '    frame: "1e5"\n'
        '    "on": true\n'
        "    rate: 5\n"
        "    # raw: bytes, which a file of parameters cannot hold\n"
        "    wheel:\n"
        '      names: ["left", "y"]\n'
        "      radius: 0.03\n"
    )


def test_a_parameter_whose_name_begins_another_one_keeps_both() -> None:
    values: dict[str, tuple[str, Any]] = {"a": ("integer", 1), "a.b": ("integer", 2)}
    assert load(dump("/n", rows(values)), "/n") == {"a": 1, "a.b": 2}


def test_a_node_without_parameters_is_written_and_read() -> None:
    assert load(dump("/n", []), "/n") == {}


@pytest.mark.parametrize(
    ("node", "expected"),
    [
        ("/robot", {"a": 1, "b": 2}),
        ("/arm/robot", {"a": 3, "c": 4}),
        ("/arm/left/hand", {"a": 1, "d": 5}),
    ],
)
def test_wildcards_and_nested_namespaces_are_those_of_ros(
    node: str, expected: dict[str, int]
) -> None:
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


TWICE = """\
/**:
  left:
    ros__parameters: {wheels: {separation: 0.16}, a: 1}
/robot:
  ros__parameters: {a: 5, b.c: 1}
/**:
  robot:
    ros__parameters: {publish_tf: true, a: 1, a: 2}
  left:
    ros__parameters: {wheels: {radius: 0.03}, a: [1, 2]}
/robot:
  ros__parameters:
    b: {c: 2, d: 3}
"""


@pytest.mark.parametrize(
    ("node", "expected"),
    [
        ("/robot", {"publish_tf": True, "a": 5, "b.c": 2, "b.d": 3}),
        ("/far/away/robot", {"publish_tf": True, "a": 2}),
        ("/left", {"wheels.separation": 0.16, "wheels.radius": 0.03, "a": [1, 2]}),
    ],
)
def test_what_appears_again_is_added_where_it_was_first(
    node: str, expected: dict[str, object]
) -> None:
    """As in ROS, where TurtleBot3 has such a file."""
    assert load(TWICE, node) == expected


@pytest.mark.parametrize(
    ("pattern", "node", "fits"),
    [
        ("/*", "/robot", True),
        ("/*", "/arm/robot", False),
        ("/*/robot", "/arm/robot", True),
        ("/**/robot", "/robot", True),
        ("/**/robot", "/a/b/robot", True),
        ("/**/robot", "/a/b/robots", False),
        ("/arm/**", "/arm", True),
        ("/arm/**", "/arm/left/hand", True),
        ("/arm/*/hand", "/arm/hand", False),
        # As std::regex has it: one that is not after a slash repeats the letter before it.
        ("/robot*", "/robott", True),
        ("/robot*", "/robot_1", False),
        ("/***", "/robot", False),
        ("/ro.ot", "/robot", False),
        ("robot", "/robot", True),
    ],
)
def test_wildcards_fit_as_in_ros(pattern: str, node: str, fits: bool) -> None:
    text = f'"{pattern}":\n  ros__parameters: {{a: 1}}\n'
    if fits:
        assert load(text, node) == {"a": 1}
    else:
        with pytest.raises(YamlError, match="the file has nothing for"):
            load(text, node)


def test_wildcards_can_be_left_out() -> None:
    text = "/**:\n  ros__parameters: {a: 1}\nrobot:\n  ros__parameters: {b: 2}\n"
    assert load(text, "/robot", wildcards=False) == {"b": 2}


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


@given(st.text(max_size=200))
def test_any_text_is_read_or_refused_in_words(text: str) -> None:
    with contextlib.suppress(YamlError):
        load(text, "/robot")


def test_a_file_is_written_whole_and_read(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    save_file(path, "/robot", rows({"имя": ("string", "Ёж")}))
    assert load_file(path, "/robot") == {"имя": "Ёж"}
    assert [each.name for each in tmp_path.iterdir()] == ["robot.yaml"]


def test_a_file_that_is_there_is_replaced_only_on_demand(tmp_path: Path) -> None:
    path, link = tmp_path / "robot.yaml", tmp_path / "link.yaml"
    path.write_text("old")
    link.symlink_to(path)
    for each in (path, link):
        with pytest.raises(FileExistsError):
            save_file(each, "/robot", ())
    assert path.read_text() == "old"
    save_file(link, "/robot", rows({"имя": ("string", "Ёж")}), replace=True)
    assert load_file(path, "/robot") == {"имя": "Ёж"}
    assert link.is_symlink()
    assert sorted(each.name for each in tmp_path.iterdir()) == ["link.yaml", "robot.yaml"]


def test_what_lies_beside_a_file_is_not_taken_for_its_draft(tmp_path: Path) -> None:
    beside = tmp_path / f".robot.yaml.{os.getpid()}"
    beside.write_text("mine")
    with contextlib.suppress(OSError):
        save_file(tmp_path / "robot.yaml", "/robot", ())
    assert beside.read_text() == "mine"


@pytest.mark.parametrize(
    ("raw", "line"), [(b"a:\n \xff\xfe: 1\n", 2), (b"a:\n b:\n\0 c\n", 3), (b"\x89PNG\r\n", 1)]
)
def test_a_file_that_is_no_text_is_told(tmp_path: Path, raw: bytes, line: int) -> None:
    path = tmp_path / "picture.yaml"
    path.write_bytes(raw)
    with pytest.raises(YamlError) as caught:
        load_file(path, "/robot")
    assert caught.value.line == line
