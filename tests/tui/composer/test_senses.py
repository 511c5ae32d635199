"""What the Composer tells a model of the robot: what the screen has just seen, and nothing old."""

from __future__ import annotations

from graph.data import Sample
from robot.topics import LLM_RESULT, SAFETY_STATE, SONAR_FRONT
from tui import clock
from tui.composer.senses import FRESH_S, RobotSenses

DIAGNOSTICS = "diagnostic_msgs/msg/DiagnosticArray"
GATE = {"status": [{"name": "safety_stop", "message": "forward is blocked", "values": []}]}


def seen(topic: str, kind: str, value: object, age_s: float = 0.0) -> dict[str, tuple[Sample, ...]]:
    return {topic: (Sample(topic, kind, clock.now() - age_s, 0.0, 100, value),)}  # type: ignore[arg-type]


def test_the_model_is_told_what_the_screen_sees() -> None:
    """Distance, the gate's sentence, and what became of the last commands."""
    senses = RobotSenses()
    senses.see(seen(SONAR_FRONT, "std_msgs/msg/Float32", {"data": 1.25}))
    senses.see(seen(SAFETY_STATE, DIAGNOSTICS, GATE))
    refused = '{"event": "refused", "problems": []}'
    senses.see(seen(LLM_RESULT, "std_msgs/msg/String", {"data": refused}))
    situation = senses.situation("go on")
    assert (situation.heard, situation.front_m, situation.gate) == (
        "go on",
        1.25,
        "forward is blocked",
    )
    assert situation.refused


def test_what_is_old_is_unknown() -> None:
    senses = RobotSenses()
    senses.see(seen(SONAR_FRONT, "std_msgs/msg/Float32", {"data": 1.25}, FRESH_S + 1))
    senses.see(seen(SAFETY_STATE, DIAGNOSTICS, GATE, FRESH_S + 1))
    assert (senses.situation("").front_m, senses.situation("").gate) == (None, "")
