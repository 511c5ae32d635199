"""What the gate would do, by its own report."""

from __future__ import annotations

import math

import pytest

from agents.preview import preview_of
from robot.safety.gate_report import Gate


def gate(verdict: str = "free", front: float = 3.0, rear: float = 3.0) -> Gate:
    """A gate that stops at 0.5 m and slows down at 1 m."""
    return Gate(verdict, metres={"front": front, "rear": rear}, critical_m=0.5, slow_m=1.0)


@pytest.mark.parametrize(
    ("report", "speed", "lets", "reach_m", "words"),
    [
        (gate(), 0.2, True, 0.4, "the gate would let it: free for 3.00 m"),
        (gate(front=1.2), 0.2, True, 0.4, "the gate would slow it down: obstacle at 1.20 m"),
        (gate(front=0.7), 0.2, True, 0.2, "would stop it after 0.20 m: obstacle at 0.70 m"),
        (gate(front=math.inf), 0.2, True, 0.4, "the gate would let it: nothing in range"),
        (gate("blocked_forward", 0.4), 0.2, False, 0.0, "would hold it: obstacle at 0.40 m"),
        (gate("blocked_forward", 0.4), -0.2, True, 0.4, "the gate would let it: free for 3.00 m"),
        (gate("blocked_backward", rear=0.1), -0.2, False, 0.0, "would hold it: obstacle at 0.10"),
        (gate("blocked", 0.4), 0.2, False, 0.0, "would hold it"),
        (gate("emergency_stop"), 0.2, False, 0.0, "would hold it: emergency stop"),
        (gate("starting"), 0.2, False, 0.0, "would hold it: it is starting"),
        (Gate("free"), -0.2, True, 0.4, "no sensor sees that way"),
        (Gate("blocked_forward", {"front": "silent"}), 0.2, False, 0.0, "gives no distance"),
    ],
)
def test_what_it_would_do(
    report: Gate, speed: float, lets: bool, reach_m: float, words: str
) -> None:
    found = preview_of(report, speed, 0.4)
    assert found.lets == lets
    assert found.reach_m == pytest.approx(reach_m)
    assert words in str(found.words)
