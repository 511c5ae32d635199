"""What came of a sent message: each step with its delay, and plain words where none came."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest

from graph.data import Sample
from robot.commands.schema import parse_llm
from tests.tui.recorded import NOW_S, joints, sample
from tui.outcome.trail import OutcomeTrail
from tui.outcome.view import delay_text

SENT_S = NOW_S + 100
LOOK_AND_DRIVE = parse_llm(
    '{"thought": "", "commands": [{"action": "turn_head", "pan": -45, "tilt": 10},'
    ' {"action": "drive", "speed": 0.2, "steering": -0.3}]}'
)


def at(delay_s: float, message: Sample) -> Sample:
    """The message as if it had arrived so long after the sending, taken a little later."""
    return replace(message, received_s=SENT_S + delay_s + 0.05, age_s=0.05)


def result(**event: Any) -> Sample:
    return sample("/llm_result", "std_msgs/msg/String", {"data": json.dumps(event)})


def drive(topic: str, speed: float, steering: float) -> Sample:
    value = {"header": {}, "drive": {"speed": speed, "steering_angle": steering}}
    return sample(topic, "ackermann_msgs/msg/AckermannDriveStamped", value)


def wheels(left: float, right: float) -> Sample:
    return joints("/wheel_commands", rear_left_wheel_joint=(0.0, left), rear_right_wheel_joint=(0.0, right))


def head(pan: float, tilt: float) -> Sample:
    return joints("/head_state", pan_joint=(pan, 0.0), tilt_joint=(tilt, 0.0))


def safety(message: str) -> Sample:
    status = [{"level": b"\x02", "name": "safety_stop", "message": message}]
    return sample("/safety_state", "diagnostic_msgs/msg/DiagnosticArray", {"status": status})


def told(trail: OutcomeTrail, after_s: float = 1.0) -> list[tuple[str, str, str]]:
    return [(entry.mark, entry.topic, entry.text) for entry in trail.entries(SENT_S + after_s)]


def begun(before: dict[str, Sample] | None = None, listeners: tuple[str, ...] = ("llm_parser",)) -> OutcomeTrail:
    return OutcomeTrail(SENT_S, listeners, LOOK_AND_DRIVE, before or {})


def test_the_trail_of_a_message_is_told_in_order_with_its_delays() -> None:
    trail = begun({"/wheel_commands": wheels(0.0, 0.0)})
    trail.see(
        {
            "/wheel_commands": [at(0.005, wheels(0.0, 0.0)), at(0.031, wheels(6.2, 5.1))],
            "/drive": [at(0.015, drive("/drive", 0.2, -0.3))],
            "/drive_safe": [at(0.02, drive("/drive_safe", 0.2, -0.3))],
            "/llm_result": [at(0.012, result(event="accepted", commands=2, thought="I look"))],
        }
    )
    trail.see(
        {
            "/head_state": [at(0.5, head(-0.3, 0.1)), at(1.01, head(-0.785, 0.175))],
            "/llm_result": [at(1.043, result(event="head", pan=-45, tilt=10, sum=1))],
        }
    )
    entries = trail.entries(SENT_S + 2)
    assert told(trail) == [
        ("✓", "/llm_result", "accepted: 2 commands “I look”"),
        ("→", "/drive", "0.20 m/s, -0.30 rad, to the right"),
        ("✓", "/drive_safe", "let through"),
        ("→", "/wheel_commands", "left 0.20, right 0.17 m/s"),
        ("✓", "/head_state", "pan -45°, tilt 10°"),
        ("✓", "set_head_position", "pan -45°, tilt 10°: done"),
    ]
    assert [delay_text(entry.delay_s) for entry in entries] == [
        "12 ms", "15 ms", "20 ms", "31 ms", "1010 ms", "1043 ms",
    ]  # fmt: skip


def test_a_refusal_names_every_place_and_nothing_is_awaited() -> None:
    trail = OutcomeTrail(SENT_S, ("llm_parser",), None, {})
    problem = {"field": "commands[0].speed", "line": 4, "column": 33, "message": "must be small"}
    trail.see({"/llm_result": [at(0.01, result(event="refused", problems=[problem]))]})
    assert told(trail, 10.0) == [
        ("✗", "/llm_result", "refused: nothing of it is executed"),
        ("✗", "/llm_result", "line 4, column 33: commands[0].speed: must be small"),
    ]


def test_what_safety_holds_back_is_told_with_its_reason() -> None:
    trail = begun({"/drive_safe": drive("/drive_safe", 0.0, 0.0)})
    trail.see(
        {
            "/drive": [at(0.02, drive("/drive", 0.2, -0.3))],
            "/drive_safe": [at(0.03, drive("/drive_safe", 0.0, 0.0)), at(0.4, drive("/drive_safe", 0.0, -0.3))],
            "/safety_state": [at(0.41, safety("obstacle at 0.3 m"))],
        }
    )
    assert ("!", "/drive_safe", "limited to 0.00 m/s, -0.30 rad, to the right") in told(trail)
    assert ("!", "/safety_state", "obstacle at 0.3 m") in told(trail)


@pytest.mark.parametrize(
    "data",
    ["", "null", "[1]", "{", '{"event": 7}', '{"event": "refused", "problems": 3}',
     '{"event": "refused", "problems": [null, {"args": 5, "code": "range"}]}',
     '{"event": "accepted", "commands": "many"}', '{"event": "head"}', "[" * 100_000],
)  # fmt: skip
def test_any_words_on_the_result_topic_are_survived(data: str) -> None:
    trail = begun()
    trail.see({"/llm_result": [at(0.1, sample("/llm_result", "", {"data": data}))]})
    assert trail.entries(SENT_S + 9)
