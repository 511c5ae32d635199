"""What a profile's values become: parameters, overrides, conditions."""

from __future__ import annotations

import math
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import assume, given
from hypothesis import strategies as st

from launcher import node_program
from launcher.errors import DomainError, ProfileError
from launcher.profile.load import Profile, load_profile
from launcher.profile.node import written as argument
from launcher.profile.params import NAME, flatten
from launcher.profile.reading import Problems, read_value
from launcher.profile.when import WhenError, holds
from tests.unit.profile_files import loaded, told, written
from text.yaml_scalars import meaning
from text.yaml_tree import Branch, FilePlace, MappingEntry, Scalar

TEXTS = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=40)
TRICKY = st.sampled_from(
    [
        "1", "1.0", "1e3", "true", "no", "null", "~", "", " ", "- a", "a: b", "#x", "*x", "&x",
        "!x", "{a}", "[1]", "'", '"', "\\", "\\n", "\n", "\t", "\x85", "\u2028", "\ufeff", "=",
        "<<", "0x1",
    ]
)  # fmt: skip
INTEGERS = st.integers(-(2**63), 2**63 - 1)
FLOATS = st.floats(allow_subnormal=False)
SINGLES = st.one_of(st.booleans(), INTEGERS, FLOATS, TEXTS, TRICKY)
LISTS = st.one_of(*(st.lists(kind, min_size=1, max_size=5) for kind in (st.booleans(), INTEGERS)))
VALUES = st.one_of(SINGLES, LISTS, st.lists(FLOATS, min_size=1, max_size=5), st.lists(TEXTS, min_size=1, max_size=5))


def same(first: Any, second: Any) -> bool:
    """Whether two values are the same, types and nan included."""
    if isinstance(first, list) and isinstance(second, list):
        return len(first) == len(second) and all(map(same, first, second))
    if isinstance(first, float) and math.isnan(first):
        return isinstance(second, float) and math.isnan(second)
    return type(first) is type(second) and first == second


@given(VALUES)
def test_what_is_written_reads_back_as_the_same_value_and_type(value: Any) -> None:
    assert same(yaml.safe_load(argument(value)), value)


@given(VALUES)
def test_what_yaml_says_is_what_the_argument_says(value: Any) -> None:
    # PyYAML writes the texts 1e3, inf and 0o17 without quotes, which are numbers here.
    words = value if isinstance(value, list) else [value]
    assume(
        not any(isinstance(word, str) and not isinstance(meaning(word), (str, bool, type(None))) for word in words)
    )
    problems = Problems()
    text = yaml.safe_dump({"p": value})
    tree = read_value(text, "test", problems)
    assert tree is not None
    assert problems.found == []
    flat = flatten(tree, (), problems)
    assert problems.found == []
    assert same(yaml.safe_load(argument(flat["p"])), value)


@pytest.mark.parametrize(
    ("yaml_value", "argument"),
    [
        ('"1"', 'p:="1"'), ("1", "p:=1"), ("1.0", "p:=1.0"), ("1e3", "p:=1000.0"),
        ("1.5e300", "p:=1.5e+300"), ("1e16", "p:=1.0e+16"), (".inf", "p:=.inf"),
        ("yes", "p:=true"), ('"yes"', 'p:="yes"'),
        ("12:30", 'p:="12:30"'), ("2026-01-02", 'p:="2026-01-02"'), ("0x10", "p:=16"),
        ("[1, 2.5]", "p:=[1.0, 2.5]"), ('["1", a]', 'p:=["1", "a"]'), ("привет", 'p:="привет"'),
        ('"a\\nb\\u0007"', 'p:="a\\nb\\u0007"'), ("{a: {b: 1}}", "p.a.b:=1"),
    ],
)  # fmt: skip
def test_the_command_line_of_a_node(yaml_value: str, argument: str, tmp_path: Path) -> None:
    profile = loaded(tmp_path, f"nodes: {{a: {{exec: [x], params: {{p: {yaml_value}}}}}}}")
    assert profile.nodes["a"].argv() == ["x", "--ros-args", "-p", argument]


def test_a_run_node_is_named_remapped_and_given_its_parameters(tmp_path: Path) -> None:
    profile = loaded(tmp_path, "nodes: {a: {run: nodes.hello, remap: {/drive: /safe}, params: {rate: 2.0}}}")
    argv = profile.nodes["a"].argv()
    assert argv[1:4] == ["-u", node_program.__file__, "nodes.hello"]
    assert argv[4:] == [*("--ros-args", "-r", "__node:=a", "-r", "/drive:=/safe"), *("-p", "rate:=2.0")]


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


BASE = """\
title: {en: Base, ru: Основа}
lesson: 1
nodes:
  sonar:
    run: nodes.hello
    params: {rate: 1.0, limits: {near: 0.2, far: 3.0}}
    ready: {topic: /scan, within: 3}
  camera: {exec: [camera]}
devices:
  pico: {port: /dev/ttyACM0, baud: 115200}
panels: [sonar]
"""


def extended(folder: Path, text: str) -> Profile:
    written(folder, BASE, "base.yaml")
    return loaded(folder, "extends: base\n" + text)


def test_a_parameter_deep_down_is_overridden_and_the_rest_stays(tmp_path: Path) -> None:
    profile = extended(tmp_path, "nodes: {sonar: {params: {limits: {near: 0.5}}}}")
    assert profile.nodes["sonar"].params == {"rate": 1.0, "limits.near": 0.5, "limits.far": 3.0}
    assert profile.nodes["sonar"].run == "nodes.hello"
    assert profile.title == {"en": "Base", "ru": "Основа"}
    assert profile.panels == ("sonar",)


def test_a_node_is_taken_out_by_null_and_one_added(tmp_path: Path) -> None:
    profile = extended(tmp_path, "nodes: {camera: null, brain: {exec: [x], needs: [sonar]}}")
    assert list(profile.nodes) == ["sonar", "brain"]


@pytest.mark.parametrize(
    ("override", "name", "value"),
    [
        ("a.rate=2.5", "rate", 2.5), ("a.rate=2", "rate", 2), ('a.rate="2"', "rate", "2"),
        ("a.word=налево", "word", "налево"), ("a.empty=", "empty", ""),
        ("a.limits.near=0.5", "limits.near", 0.5), ("a.list=[1, 2]", "list", [1, 2]),
        ("a.url=http://x/?a=b", "url", "http://x/?a=b"), ("a.deep={x: 1}", "deep.x", 1),
    ],
)  # fmt: skip
def test_set_overrides_a_parameter(override: str, name: str, value: Any, tmp_path: Path) -> None:
    text = "nodes: {a: {exec: [x], params: {rate: 1.0, limits: {near: 1.0}}}}"
    profile = loaded(tmp_path, text, overrides=(override,))
    assert profile.nodes["a"].params[name] == value
    assert type(profile.nodes["a"].params[name]) is type(value)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("rate=1", "expected node.param=value (write --set sonar_front.rate=2.0)"),
        ("a.rate", "expected node.param=value"),
        (".rate=1", "expected node.param=value"),
        ("sonr.rate=1", "there is no node 'sonr' (did you mean sonar?)"),
        ("sonar.rate=[", "a value is missing here, or a ']' or '}'"),
        ("sonar.rate=[]", "sonar.rate: an empty list has no type in ROS"),
        ("sonar.ra te=1", "'ra te' is not a valid name for a ROS parameter"),
        ("real.rate=1", "real does not run on this hardware"),
    ],
)
def test_a_wrong_set_is_told(override: str, message: str, tmp_path: Path) -> None:
    text = 'nodes:\n  sonar: {exec: [x]}\n  real: {exec: [x], when: hardware == "real"}'
    messages = told(tmp_path, text, overrides=(override,))
    assert len(messages) == 1
    assert messages[0].startswith(f"--set {override}")
    assert message in messages[0]


DEVICES = """\
devices:
  pico: {port: /dev/ttyACM0, baud: 115200, scale: 1.5}
nodes:
  chassis:
    exec: [chassis, --url, "serial:${devices.pico.port}", "${HOME}"]
    params: {port: "${devices.pico.port}", baud: "${devices.pico.baud}", k: "${devices.pico.scale}"}
    env: {PORT: "${devices.pico.port}"}
"""


def test_devices_are_put_in_with_their_types(tmp_path: Path) -> None:
    node = loaded(tmp_path, DEVICES).nodes["chassis"]
    assert node.params == {"port": "/dev/ttyACM0", "baud": 115200, "k": 1.5}
    assert node.exec == ("chassis", "--url", "serial:/dev/ttyACM0", "${HOME}")
    assert node.env == {"PORT": "/dev/ttyACM0"}


def test_variables_override_devices(tmp_path: Path) -> None:
    path = written(tmp_path, DEVICES)
    profile = load_profile(path, environ={"DECK_PICO_PORT": "/dev/x", "DECK_PICO_BAUD": "9600"})
    assert profile.nodes["chassis"].params == {"port": "/dev/x", "baud": 9600, "k": 1.5}
    assert profile.devices["pico"] == {"port": "/dev/x", "baud": 9600, "scale": 1.5}


def test_a_variable_of_the_wrong_type_is_told(tmp_path: Path) -> None:
    path = written(tmp_path, DEVICES)
    with pytest.raises(ProfileError, match="DECK_PICO_BAUD=fast replaces 115200, but is of anoth"):
        load_profile(path, environ={"DECK_PICO_BAUD": "fast"})


PLAIN = "nodes: {a: {exec: [x]}}"


def test_whose_domain_counts(tmp_path: Path) -> None:
    path = written(tmp_path, "domain: 7\n" + PLAIN)
    other = written(tmp_path, PLAIN, "other.yaml")
    assert load_profile(path, domain=9, environ={"ROS_DOMAIN_ID": "8"}).domain == 9
    assert load_profile(path, environ={"ROS_DOMAIN_ID": "8"}).domain == 7
    assert load_profile(other, environ={"ROS_DOMAIN_ID": "8"}).domain == 8
    assert 1 <= load_profile(other, environ={}).domain <= 101


@pytest.mark.parametrize("domain", ["x", "-1", "233", "1.5", "١٢٣٤"])
def test_a_domain_of_the_environment_that_is_none_is_told(domain: str, tmp_path: Path) -> None:
    with pytest.raises(DomainError, match=r"ROS_DOMAIN_ID: .* whole number from 0 to 232"):
        load_profile(written(tmp_path, PLAIN), environ={"ROS_DOMAIN_ID": domain})


MOCK = {"hardware": "mock"}
REAL = {"hardware": "real"}


@pytest.mark.parametrize(
    ("expression", "on_mock", "on_real"),
    [
        ('hardware == "mock"', True, False),
        ('"mock" == hardware', True, False),
        ('hardware != "mock"', False, True),
        ('hardware in ["mock", "real"]', True, True),
        ('hardware not in ("mock",)', False, True),
        ('not hardware == "mock"', False, True),
        ('hardware == "mock" or hardware == "real"', True, True),
        ('hardware == "mock" and not (hardware == "real")', True, False),
    ],
)
def test_what_an_expression_says(expression: str, on_mock: bool, on_real: bool) -> None:
    assert holds(expression, MOCK) is on_mock
    assert holds(expression, REAL) is on_real


@pytest.mark.parametrize(
    "expression",
    [
        "", "hardware", "True", "hardware == 1", "hardware == other", 'hardware < "mock"',
        'hardware == "mock" == "mock"', '__import__("os").system("true") == "mock"',
        'hardware.upper() == "MOCK"', '[x for x in "ab"] == "mock"', 'hardware in "mock"',
        "(" * 5000, "not " * 40 + 'hardware == "mock"' + " " * 100, 'hardware == "mock"\0',
    ],
)  # fmt: skip
def test_anything_else_is_refused(expression: str) -> None:
    with pytest.raises(WhenError):
        holds(expression, MOCK)


@given(st.text(max_size=60))
def test_any_text_is_an_answer_or_refused(expression: str) -> None:
    with suppress(WhenError):
        assert holds(expression, MOCK) in (True, False)


TWO_WORLDS = """\
nodes:
  mock_sonar: {exec: [x], when: hardware == "mock"}
  real_sonar: {exec: [x], when: hardware == "real"}
  brain: {exec: [x], needs: [mock_sonar, real_sonar]}
"""


def test_a_profile_with_nothing_left_is_refused(tmp_path: Path) -> None:
    text = 'nodes: {a: {exec: [x], when: hardware == "real"}}'
    assert told(tmp_path, text) == ["1:1: nodes: no node is left with --hardware mock"]


def test_an_unknown_hardware_is_refused(tmp_path: Path) -> None:
    assert told(tmp_path, TWO_WORLDS, hardware="moc") == ["--hardware: expected mock or real, found 'moc'"]


def test_a_node_has_the_roles_of_its_module_and_those_that_the_profile_says(tmp_path: Path) -> None:
    written(tmp_path, "nodes: {wheels: {run: nodes.chassis, roles: [brain]}, own: {run: nodes.hello}}", "deck.yaml")
    (tmp_path / "own.py").touch()
    profile = loaded(
        tmp_path, "extends: ./deck.yaml\nnodes: {own: {run: ./own.py, roles: [gate]}, plain: {run: ./own.py}}"
    )
    assert {name: node.roles for name, node in profile.nodes.items()} == {
        "wheels": ("drives", "driver", "brain"),
        "own": ("gate",),
        "plain": (),
    }
    assert [node.drives for node in profile.nodes.values()] == [True, False, False]
