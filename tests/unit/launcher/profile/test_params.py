"""Parameters reach the node as YAML said them: `-p name:=value` reads back to the same value."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import assume, given
from hypothesis import strategies as st

from launcher import node_program
from launcher.profile.params import NAME, flatten, written
from launcher.profile.problems import Problems
from launcher.profile.reading import read_value, read_yaml
from tests.unit.profile_files import loaded
from text.yaml_scalars import meaning
from text.yaml_tree import Branch, FilePlace, MappingEntry, Scalar

TEXTS = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=40)
TRICKY = st.sampled_from(
    [
        "1",
        "1.0",
        "1e3",
        "true",
        "no",
        "null",
        "~",
        "",
        " ",
        "- a",
        "a: b",
        "#x",
        "*x",
        "&x",
        "!x",
        "{a}",
        "[1]",
        "'",
        '"',
        "\\",
        "\\n",
        "\n",
        "\t",
        "\x85",
        "\u2028",
        "\ufeff",
        "=",
        "<<",
        "0x1",
    ]
)
INTEGERS = st.integers(-(2**63), 2**63 - 1)
FLOATS = st.floats(allow_subnormal=False)
SINGLES = st.one_of(st.booleans(), INTEGERS, FLOATS, TEXTS, TRICKY)
LISTS = st.one_of(*(st.lists(kind, min_size=1, max_size=5) for kind in (st.booleans(), INTEGERS)))
VALUES = st.one_of(
    SINGLES,
    LISTS,
    st.lists(FLOATS, min_size=1, max_size=5),
    st.lists(TEXTS, min_size=1, max_size=5),
)


def same(first: Any, second: Any) -> bool:
    """Whether two values are the same, types and nan included."""
    if isinstance(first, list) and isinstance(second, list):
        return len(first) == len(second) and all(map(same, first, second))
    if isinstance(first, float) and math.isnan(first):
        return isinstance(second, float) and math.isnan(second)
    return type(first) is type(second) and first == second


@given(VALUES)
def test_what_is_written_reads_back_as_the_same_value_and_type(value: Any) -> None:
    assert same(yaml.safe_load(written(value)), value)


@given(VALUES)
def test_what_yaml_says_is_what_the_argument_says(value: Any) -> None:
    # PyYAML writes the texts 1e3, inf and 0o17 without quotes, which are numbers here.
    words = value if isinstance(value, list) else [value]
    assume(
        not any(
            isinstance(word, str) and not isinstance(meaning(word), (str, bool, type(None)))
            for word in words
        )
    )
    problems = Problems()
    text = yaml.safe_dump({"p": value})
    tree = read_value(text, "test", problems)
    assert tree is not None
    assert problems.found == []
    flat = flatten(tree, (), problems)
    assert problems.found == []
    assert same(yaml.safe_load(written(flat["p"])), value)


@given(st.text(max_size=30))
def test_any_text_after_set_is_a_value_or_a_problem_and_never_a_crash(text: str) -> None:
    problems = Problems()
    tree = read_value(text, "--set", problems)
    assert (tree is None) == bool(problems.found)


@given(st.text(max_size=200))
def test_any_text_in_a_file_is_a_profile_or_problems_and_never_a_crash(text: str) -> None:
    problems = Problems()
    tree = read_yaml(text, "test", problems)
    assert tree is not None or problems.found


@pytest.mark.parametrize(
    ("yaml_value", "argument"),
    [
        ('"1"', 'p:="1"'),
        ("1", "p:=1"),
        ("1.0", "p:=1.0"),
        ("1e3", "p:=1000.0"),
        ("1.5e300", "p:=1.5e+300"),
        (".inf", "p:=.inf"),
        ("yes", "p:=true"),
        ('"yes"', 'p:="yes"'),
        ("12:30", 'p:="12:30"'),
        ("2026-01-02", 'p:="2026-01-02"'),
        ("0x10", "p:=16"),
        ("[1, 2.5]", "p:=[1.0, 2.5]"),
        ('["1", a]', 'p:=["1", "a"]'),
        ("привет", 'p:="привет"'),
        ('"a\\nb\\u0007"', 'p:="a\\nb\\x07"'),
        ("{a: {b: 1}}", "p.a.b:=1"),
    ],
)
def test_the_command_line_of_a_node(yaml_value: str, argument: str, tmp_path: Path) -> None:
    profile = loaded(tmp_path, f"nodes: {{a: {{exec: [x], params: {{p: {yaml_value}}}}}}}")
    assert profile.nodes["a"].argv() == ["x", "--ros-args", "-p", argument]


def test_a_run_node_is_named_remapped_and_given_its_parameters(tmp_path: Path) -> None:
    profile = loaded(
        tmp_path, "nodes: {a: {run: nodes.hello, remap: {/drive: /safe}, params: {rate: 2.0}}}"
    )
    argv = profile.nodes["a"].argv()
    assert argv[1:4] == ["-u", node_program.__file__, "nodes.hello"]
    assert argv[4:] == [
        *("--ros-args", "-r", "__node:=a", "-r", "/drive:=/safe"),
        *("-p", "rate:=2.0"),
    ]


def test_a_command_without_parameters_stays_as_it_is_written(tmp_path: Path) -> None:
    profile = loaded(tmp_path, "nodes: {a: {exec: [ros2, run, --x, 0.10, 010, yes, 1e3]}}")
    assert profile.nodes["a"].argv() == ["ros2", "run", "--x", "0.10", "010", "yes", "1e3"]


@pytest.mark.parametrize("name", ["a", "a.b", "_x1", "qos_overrides./scan.publisher.depth"])
def test_names_that_ros_knows(name: str) -> None:
    assert NAME.fullmatch(name)


@pytest.mark.parametrize(
    ("value", "told"),
    [
        ("a\0b", "ROS cannot carry a NUL character in a string"),
        ("\ud800", "an incomplete character: a lone surrogate"),
        (5e-324, "5e-324 is too small for ROS"),
        ("x" * 40_000, "the text is longer than 32768 characters"),
    ],
)
def test_what_ros_cannot_carry_is_refused(value: str | float, told: str) -> None:
    problems = Problems()
    place = FilePlace("test", 1, 4)
    tree = Branch({"p": MappingEntry(place, Scalar(value, str(value), place))}, place)
    assert flatten(tree, (), problems) == {}
    assert [problem.message for problem in problems.found] == [told]
    assert (problems.found[0].line, problems.found[0].column) == (1, 4)
