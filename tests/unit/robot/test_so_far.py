"""The beginning of a response: only what no continuation can mend is a problem."""

from __future__ import annotations

import json

import pytest

from robot.commands.schema import parse_llm, so_far

DRIVE = {"action": "drive", "speed": 0.2, "steering": -0.1}
LOOK = {"action": "turn_head", "pan": -45, "tilt": 0}
GOOD = {"thought": 'a "wall" \\ [ahead], }', "commands": [DRIVE, LOOK]}


@pytest.mark.parametrize("indent", [None, 2])
def test_no_beginning_of_a_valid_response_is_wrong(indent: int | None) -> None:
    text = json.dumps(GOOD, indent=indent)
    parse_llm(text)
    counts = []
    for end in range(len(text) + 1):
        count, problems = so_far(text[:end])
        assert problems == (), text[:end]
        counts.append(count)
    assert sorted(counts) == counts
    assert counts[-1] == 2
    assert 1 in counts


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ('{"thought": "x", "commands": [{"action": "drive", "speed": 5, "steering": 0}', "0.5 m/s"),
        ('{"thought": "x", "commands": [{"action": "jump"},', "must be one of"),
        ('{"thought": "x", "commands": [{"action": "drive", "speed": 0}', "steering is missing"),
        ('{"thought": "x", "say": "hello", ', "there is no field say"),
        ('{"thought": "x"]', "a comma or }"),
    ],
)
def test_what_is_wrong_already_is_said_at_once(text: str, problem: str) -> None:
    _count, problems = so_far(text)
    assert problem in " ".join(map(str, problems))


def test_a_value_that_is_still_being_written_is_no_problem() -> None:
    """`-0.` may become `-0.3`, and `tr` may become `true`: nothing is said before the comma."""
    assert so_far('{"thought": "x", "commands": [{"action": "drive", "speed": 5') == (0, ())
