"""`when:` knows the hardware and a little logic, and executes nothing."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from launcher.profile.when import WhenError, holds
from tests.unit.profile_files import loaded, told

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
        "",
        "hardware",
        "True",
        "hardware == 1",
        "hardware == other",
        'hardware < "mock"',
        'hardware == "mock" == "mock"',
        '__import__("os").system("true") == "mock"',
        'hardware.upper() == "MOCK"',
        '[x for x in "ab"] == "mock"',
        'hardware in "mock"',
        "(" * 5000,
        "not " * 40 + 'hardware == "mock"' + " " * 100,
        'hardware == "mock"\0',
    ],
)
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


def test_a_node_left_out_is_not_waited_for(tmp_path: Path) -> None:
    profile = loaded(tmp_path, TWO_WORLDS, hardware="real")
    assert list(profile.nodes) == ["real_sonar", "brain"]
    assert profile.nodes["brain"].needs == ("real_sonar",)


def test_a_profile_with_nothing_left_is_refused(tmp_path: Path) -> None:
    text = 'nodes: {a: {exec: [x], when: hardware == "real"}}'
    assert told(tmp_path, text) == ["1:1: nodes: no node is left with --hardware mock"]


def test_an_unknown_hardware_is_refused(tmp_path: Path) -> None:
    assert told(tmp_path, TWO_WORLDS, hardware="moc") == [
        "--hardware: expected mock or real, found 'moc'"
    ]
