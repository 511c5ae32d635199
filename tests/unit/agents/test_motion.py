"""What a list of commands comes to, and which no approval lets through."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest

from agents.motion import MAX_HEADS, check_rules, motion_words, read_motion
from agents.refusal import RefusedError
from launcher.consent import AgentRules
from robot.commands.schema import parse_llm

RULES = AgentRules(max_speed_m_s=0.2, max_distance_m=0.5)


def drive(speed: float, steering: float = 0.0) -> dict[str, Any]:
    """A drive."""
    return {"action": "drive", "speed": speed, "steering": steering}


def head(pan: int, tilt: int = 0) -> dict[str, Any]:
    """A turn of the head."""
    return {"action": "turn_head", "pan": pan, "tilt": tilt}


def test_a_drive_goes_as_far_as_it_is_repeated() -> None:
    motion = read_motion([drive(-0.2), head(-45, 10)])
    assert motion.moves_wheels
    assert motion.distance_m(2.0) == pytest.approx(0.4)
    assert [str(words) for words in motion_words(motion, 2.0)] == [
        "drives at -0.2 m/s, steering 0 rad, for 2 s: 0.40 m at most",
        "turns the head (pan/tilt): -45°/10°",
    ]


def test_what_is_sent_is_what_was_checked() -> None:
    motion = read_motion([head(-45, 10), drive(0.1, 0.2)])
    sent = parse_llm(motion.response("p1: why"))
    assert sent.thought == "p1: why"
    assert [command.action for command in sent.commands] == ["drive", "turn_head"]
    assert json.loads(motion.response(""))["commands"][0] == drive(0.1, 0.2)


@pytest.mark.parametrize("speed", [0.2, -0.2, 0.0])
def test_what_the_rules_permit(speed: float) -> None:
    check_rules(read_motion([drive(speed)]), RULES, 2.5)


@pytest.mark.parametrize(
    ("speed", "repeat_for_s", "word"),
    [(0.21, 1.0, "too fast"), (-0.3, 1.0, "too fast"), (0.2, 2.6, "too far"), (0.1, 60, "too far")],
)
def test_what_no_approval_lifts(speed: float, repeat_for_s: float, word: str) -> None:
    with pytest.raises(RefusedError, match=word):
        check_rules(read_motion([drive(speed)]), RULES, repeat_for_s)


@pytest.mark.parametrize(
    "commands",
    [
        [],
        [drive(0.1), drive(0.0)],
        [head(1)] * (MAX_HEADS + 1),
        [drive(0.6)],
        [drive(math.nan)],
        [drive(math.inf)],
        [head(91)],
        [{"action": "fly"}],
        [{**drive(0.1), "for": 3}],
        ["drive"],
        [{1: object()}],
        [drive(0.1)] * 1000,
    ],
)
def test_what_is_no_motion(commands: list[Any]) -> None:
    with pytest.raises(RefusedError):
        read_motion(commands)
