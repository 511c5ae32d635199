"""Parameters: what is taken, what is refused, and how the refusal reads, at the start and later."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import DescribeParameters, GetParameters, SetParameters

from nodes.parts.node import BadValueError, Choice, Number, Setting, Switch, Text, Whole
from tests.ros.node_thread import NodeThread, node_of
from tests.ros.peer import DISCOVERY, ROOT, Peer

if TYPE_CHECKING:
    from collections.abc import Iterator

RATE = Number(1.0, "Readings a second", low=0.1, high=200.0, unit="Hz")
MODULES = (
    "hello", "mock_sonar", "safety_stop", "head_controller", "ai_driver", "electronic_differential",
    "camera_tf", "mock_camera", "vlm_agent_stub", "vlm_agent", "mock_audio", "audio", "ai_brain",
    "realtime_brain", "llm_parser", "drive_to_point", "mock_robot", "tof_sonar", "chassis",
    "hearing", "speaking", "robot_state_publisher",
)  # fmt: skip


def settings_of(name: str) -> list[Setting[Any]]:
    return list(node_of(f"nodes.{name}").settings().values())


@pytest.mark.parametrize("module", MODULES)
def test_every_parameter_is_described_and_takes_its_own_default(module: str) -> None:
    for setting in settings_of(module):
        assert setting.about, setting
        assert setting.accept(setting.default) == setting.default
        if isinstance(setting, (Number, Whole)):
            assert setting.low < setting.high
        descriptor = setting.descriptor()
        assert descriptor.description == setting.about


@given(st.floats() | st.integers() | st.booleans() | st.text() | st.none())
def test_a_number_is_inside_its_range_or_refused(value: object) -> None:
    try:
        taken = RATE.accept(value)
    except BadValueError:
        return
    assert 0.1 <= taken <= 200.0
    assert not isinstance(value, bool)


@pytest.mark.parametrize(
    ("setting", "value"),
    [
        (RATE, math.nan),
        (RATE, True),
        (RATE, "1.0"),
        (Whole(4, "", low=0, high=8), 2.5),
        (Whole(4, "", low=0, high=8), 9),
        (Whole(4, "", low=0, high=8), True),
        (Switch(False, ""), 1),
        (Text("/a", ""), ""),
        (Text("/a", ""), 5),
        (Choice("a", "", choices=("a", "b")), "c"),
    ],
)
def test_nonsense_is_refused(setting: Setting[Any], value: object) -> None:
    with pytest.raises(BadValueError):
        setting.accept(value)


BAD_STARTS = [
    ("mock_sonar", "rate", "0.0", "parameter rate is 0.0, but must be a number from 0.1 to 200 Hz"),
    ("mock_sonar", "rate", "fast", "parameter rate is 'fast', but must be a number"),
    ("mock_sonar", "pattern", "square", "must be one of: random, sweep, constant"),
    ("mock_sonar", "rte", "2.0", "there is no parameter rte; did you mean rate?"),
    ("mock_sonar", "a", "2.0", "there is no parameter a; there are: topic, rate, "),
    ("hello", "a", "1", "there is no parameter a; there are: period"),
    ("mock_sonar", "min_distance", "5.0", "must be below max_distance"),
    ("mock_sonar", "topic", "/a b", "/a b"),
    ("electronic_differential", "wheelbase", "-0.25", "parameter wheelbase is -0.25"),
    ("head_controller", "queue", "1.5", "a whole number from 0 to 64"),
    ("safety_stop", "gate", "1", "parameter gate is 1, but must be true or false"),
    ("camera_tf", "child", "base_link", "must differ"),
]


OTHER_STARTS = [
    (["5"], "2", "не знает 5"),
    (["--ros-args", "-p", "rate"], "2", "Couldn't parse"),
    (["--ros-args", "-p", "x:=\udcf0"], "2", "этот аргумент — не текст в UTF-8"),
    (["--help"], "0", "rate = 1.0  (0.1 .. 200 Hz)"),
]
STARTS = """
import importlib, json, sys
from nodes.parts.runner import run
from tests.ros.node_thread import node_of
for module, words in json.loads(sys.argv[1]):
    print(run(node_of(module), words), flush=True)
"""


def run_in_one_process(starts: list[tuple[str, list[str]]], domain: int, lang: str) -> list[str]:
    """Start one after the other in one process: most of the time of a start goes into imports."""
    done = subprocess.run(
        [sys.executable, "-c", STARTS, json.dumps(starts)],
        cwd=ROOT,
        env={**os.environ, **DISCOVERY, "ROS_DOMAIN_ID": str(domain), "DECK_LANG": lang},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=True,
    )
    return done.stdout.splitlines()


def test_a_bad_parameter_ends_the_start_with_one_line_and_code_2(ros_domain: int) -> None:
    starts = [(f"nodes.{name}", ["--ros-args", "-p", f"{key}:={value}"]) for name, key, value, _ in BAD_STARTS]
    lines = iter(run_in_one_process(starts, ros_domain, "en"))
    for _name, _key, _value, words in BAD_STARTS:
        assert words in next(lines)
        assert next(lines) == "2"
    assert not list(lines)


def test_wrong_arguments_end_with_code_2_and_the_help_tells_every_parameter(ros_domain: int) -> None:
    starts = [("nodes.mock_sonar", words) for words, _code, _said in OTHER_STARTS]
    said = "\n".join(run_in_one_process(starts, ros_domain, "ru"))
    assert "Traceback" not in said
    for _words, code, words in OTHER_STARTS:
        _before, found, said = said.partition(words)
        assert found, words
        assert f"\n{code}" in said


@pytest.fixture(scope="module")
def peer(module_domain: int) -> Iterator[Peer]:
    with Peer(module_domain) as peer, NodeThread("nodes.mock_sonar", module_domain):
        yield peer


NODE = "/mock_sonar_front"


def set_parameter(peer: Peer, name: str, value: ParameterValue) -> tuple[bool, str]:
    request = SetParameters.Request(parameters=[Parameter(name=name, value=value)])
    (result,) = peer.ask(f"{NODE}/set_parameters", SetParameters, request).results
    return result.successful, result.reason


def a_double(value: float) -> ParameterValue:
    return ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=value)


def test_ros_tools_see_description_and_range(peer: Peer) -> None:
    request = DescribeParameters.Request(names=["rate", "pattern"])
    rate, pattern = peer.ask(f"{NODE}/describe_parameters", DescribeParameters, request).descriptors
    assert rate.description == "Readings a second"
    assert rate.floating_point_range[0].from_value == 0.1
    assert rate.floating_point_range[0].to_value == 200.0
    assert pattern.additional_constraints == "random, sweep, constant"


def test_nonsense_and_what_is_fixed_is_refused_at_run_time_too(peer: Peer) -> None:
    for value in (0.0, 1000.0, math.nan, math.inf):
        taken, reason = set_parameter(peer, "rate", a_double(value))
        assert not taken
        assert "rate" in reason
    text = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value="/elsewhere")
    assert not set_parameter(peer, "topic", text)[0]
    taken, reason = set_parameter(peer, "min_distance", a_double(50.0))
    assert not taken
    assert "max_distance" in reason


def test_a_whole_number_is_taken_for_one_with_a_point(peer: Peer) -> None:
    whole = ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=50)
    assert set_parameter(peer, "rate", whole) == (True, "")
    request = GetParameters.Request(names=["rate"])
    (value,) = peer.ask(f"{NODE}/get_parameters", GetParameters, request).values
    assert (value.type, value.double_value) == (ParameterType.PARAMETER_DOUBLE, 50.0)


@pytest.mark.parametrize("module", MODULES)
def test_the_documentation_tells_every_parameter(module: str) -> None:
    document = (ROOT / "docs" / "nodes.md").read_text(encoding="utf-8")
    section = document.split(f"### nodes.{module}\n")[1].split("###")[0]
    for setting in settings_of(module):
        value = setting.default
        shown = str(value).lower() if value in (True, False) else value
        default = '""' if value == "" else shown
        assert f"| {setting.name} | {default} | {setting.expected()} | {setting.about} |" in section
