"""The door for an LLM's JSON: what passes, what is refused, and how the refusal reads."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.commands.problems import TEMPLATES, CommandError, Problem
from robot.commands.schema import MAX_BYTES, MAX_COMMANDS, DriveCommand, HeadCommand, LlmResponse, parse_llm

DRIVE = {"action": "drive", "speed": 0.2, "steering": -0.3}
HEAD = {"action": "turn_head", "pan": -45, "tilt": 10}


def response(*commands: object, thought: object = "why") -> str:
    return json.dumps({"thought": thought, "commands": list(commands)})


def problems_of(text: str | bytes) -> tuple[Problem, ...]:
    with pytest.raises(CommandError) as caught:
        parse_llm(text)
    return caught.value.problems


def only_problem_of(text: str | bytes) -> Problem:
    (problem,) = problems_of(text)
    return problem


def test_the_course_s_example_is_accepted() -> None:
    parsed = parse_llm(response(HEAD, DRIVE, thought="Вижу тень справа."))
    assert parsed.thought == "Вижу тень справа."
    assert parsed.commands == [
        HeadCommand(action="turn_head", pan=-45, tilt=10),
        DriveCommand(action="drive", speed=0.2, steering=-0.3),
    ]


def test_the_ends_of_every_range_are_inside() -> None:
    for sign in (-1, 1):
        drive = {"action": "drive", "speed": 0.5 * sign, "steering": 0.5 * sign}
        head = {"action": "turn_head", "pan": 90 * sign, "tilt": 90 * sign}
        assert len(parse_llm(response(drive, head)).commands) == 2


@pytest.mark.parametrize(
    ("command", "field", "code", "words"),
    [
        ({**DRIVE, "speed": 0.51}, "speed", "range", "from -0.5 to 0.5 m/s, not 0.51"),
        ({**DRIVE, "steering": -3}, "steering", "range", "from -0.5 to 0.5 rad, not -3"),
        ({**HEAD, "pan": 91}, "pan", "range", "from -90 to 90 deg, not 91"),
        ({**HEAD, "tilt": 4.5}, "tilt", "whole", "whole number"),
        ({**HEAD, "pan": True}, "pan", "whole", "whole number"),
        ({**DRIVE, "speed": "0.1"}, "speed", "number", "must be a number"),
        ({**DRIVE, "speed": True}, "speed", "number", "must be a number"),
        ({**DRIVE, "speed": None}, "speed", "number", "must be a number"),
        ({**DRIVE, "pan": 1}, "pan", "unknown", "no field pan"),
        ({**DRIVE, "sped": 1}, "sped", "unknown_near", "did you mean speed?"),
        ({**DRIVE, "action": "fly"}, "action", "action", "one of drive, turn_head"),
        ({**DRIVE, "action": ["drive"]}, "action", "action", "one of drive, turn_head"),
        ({"action": "drive", "speed": 0.1}, "steering", "missing", "steering is missing"),
        ({"speed": 0.1}, "action", "missing", "action is missing"),
    ],
)
def test_a_refusal_names_field_and_mend(command: dict[str, object], field: str, code: str, words: str) -> None:
    problem = only_problem_of(response(HEAD, command))
    assert (problem.field, problem.code) == (f"commands[1].{field}", code)
    assert words in problem.message


def test_a_problem_points_at_the_value_in_the_text() -> None:
    drive = '{"action": "drive", "speed": 7, "steering": 0}'
    text = f'{{\n  "thought": "ы",\n  "commands": [\n    {drive}]}}'
    problem = only_problem_of(text)
    line = text.splitlines()[problem.line - 1]
    assert line[problem.column - 1 :].startswith("7,")
    assert str(problem).startswith("4:34: commands[0].speed: must be from")


def test_every_problem_is_told_in_the_order_of_the_text() -> None:
    text = response({**DRIVE, "speed": 9, "steering": 9}, 5, {**HEAD, "tilt": "up"}, thought=1)
    assert [problem.field for problem in problems_of(text)] == [
        "thought",
        "commands[0].speed",
        "commands[0].steering",
        "commands[1]",
        "commands[2].tilt",
    ]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("", "nothing"),
        ("[]", "object"),
        ('"drive"', "object"),
        ("{}", "missing"),
        ('{"thought": "x", "commands": {}}', "list"),
        ('{"thought": "x", "commands": [], "speed": 1}', "unknown"),
        ('{"thought": "x", "commands": [], "thought": "y"}', "duplicate"),
        ('{"thought": "x", "commands": []} and more', "text_after"),
        ('{"thought": NaN, "commands": []}', "not_finite"),
        (b'{"thought": "\xff"}', "encoding"),
        (" " * (MAX_BYTES + 1), "too_big"),
        ("ы" * (MAX_BYTES // 2 + 1), "too_big"),
        (response(*[DRIVE] * (MAX_COMMANDS + 1)), "too_many"),
    ],
)
def test_what_is_no_response_is_refused(text: str | bytes, code: str) -> None:
    assert problems_of(text)[0].code == code


def test_bytes_that_are_no_text_are_pointed_at() -> None:
    problem = only_problem_of('{\n "ы":'.encode() + b"\xff}")
    assert (problem.line, problem.column) == (2, 6)


def test_a_name_from_outside_is_shown_harmlessly() -> None:
    problem = only_problem_of(response({**DRIVE, "\x1b]52;c;" + "x" * 500: 1}))
    assert problem.message.isprintable()
    assert len(problem.message) < 100


def test_a_screen_can_say_every_message_in_its_own_language() -> None:
    for text in (response({**DRIVE, "speed": 9}), "[", response({**DRIVE, "sped": 1})):
        for problem in problems_of(text):
            assert TEMPLATES[problem.code].format(**problem.args) == problem.message


# ------------------------------------------------------------------ no JSON leads out of range

numbers = st.floats() | st.integers() | st.sampled_from([0.5, -0.5, 90, -90, 1e999, True])
scalars = numbers | st.none() | st.text(max_size=5) | st.sampled_from(["drive", "turn_head"])
fields = st.sampled_from(["action", "speed", "steering", "pan", "tilt", "thought", "x"])
commands = (
    st.fixed_dictionaries({"action": st.just("drive"), "speed": numbers, "steering": numbers})
    | st.fixed_dictionaries({"action": st.just("turn_head"), "pan": numbers, "tilt": numbers})
    | st.dictionaries(fields, scalars)
    | scalars
)
responses = st.fixed_dictionaries({"thought": scalars, "commands": st.lists(commands) | scalars})


def assert_in_range(text: str | bytes) -> None:
    try:
        parsed = parse_llm(text)
    except CommandError:
        return
    for command in parsed.commands:
        if isinstance(command, DriveCommand):
            assert -0.5 <= command.speed <= 0.5
            assert -0.5 <= command.steering <= 0.5
            assert math.isfinite(command.speed + command.steering)
        else:
            assert type(command.pan) is int
            assert type(command.tilt) is int
            assert abs(command.pan) <= 90
            assert abs(command.tilt) <= 90


@given(responses)
def test_no_response_leads_out_of_range(document: object) -> None:
    assert_in_range(json.dumps(document))


@given(st.text() | st.binary() | st.text('[]{}",:1e.-+drivespdctnghoumanactio \n'))
def test_no_text_whatever_leads_out_of_range(text: str | bytes) -> None:
    assert_in_range(text)


@given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.integers(-90, 90), st.integers(-90, 90))
def test_everything_in_range_is_accepted_as_it_is(speed: float, steering: float, pan: int, tilt: int) -> None:
    drive = {"action": "drive", "speed": speed, "steering": steering}
    head = {"action": "turn_head", "pan": pan, "tilt": tilt}
    parsed = parse_llm(response(drive, head))
    assert [command.model_dump() for command in parsed.commands] == [drive, head]


# ------------------------------------------------------- strict structured output takes the schema


def schema_nodes(node: Any) -> list[dict[str, Any]]:
    if isinstance(node, list):
        return [found for item in node for found in schema_nodes(item)]
    if not isinstance(node, dict):
        return []
    return [node, *(found for item in node.values() for found in schema_nodes(item))]


def test_the_schema_passes_strict_structured_output() -> None:
    """Root object, all required, nothing additional, no oneOf, no defaults, tuples or dicts."""
    schema = LlmResponse.model_json_schema()
    assert schema["type"] == "object"
    for node in schema_nodes(schema):
        assert not {"oneOf", "allOf", "default", "prefixItems", "discriminator"} & node.keys()
        if node.get("type") == "object":
            assert node["additionalProperties"] is False
            assert sorted(node["required"]) == sorted(node["properties"])


def test_the_schema_tells_the_ranges() -> None:
    definitions = LlmResponse.model_json_schema()["$defs"]
    drive, head = (definitions[name]["properties"] for name in ("DriveCommand", "HeadCommand"))
    for name in ("speed", "steering"):
        assert (drive[name]["minimum"], drive[name]["maximum"]) == (-0.5, 0.5)
    for name in ("pan", "tilt"):
        assert (head[name]["minimum"], head[name]["maximum"]) == (-90, 90)


def test_a_problem_speaks_russian() -> None:
    problem = Problem.of("range", low=-0.5, high=0.5, unit="m/s", value=7.0)
    assert problem.message == "must be from -0.5 to 0.5 m/s, not 7"
    assert problem.in_language("ru") == "должно быть от -0.5 до 0.5 м/с, а не 7"
