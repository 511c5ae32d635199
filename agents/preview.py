"""What the safety gate would do with a drive, by what it has just reported of itself."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robot.safety.gate_report import STOPPED
from text.sentences import say

if TYPE_CHECKING:
    from robot.safety.gate_report import Gate
    from text.sentences import Words


@dataclass(frozen=True)
class Preview:
    """What the gate would do."""

    words: Words
    lets: bool
    """Whether it would let the robot begin."""
    reach_m: float
    """How far the robot would come, as far as the sensors see."""


def preview_of(gate: Gate, speed_m_s: float, distance_m: float) -> Preview:
    """Return what the gate would do with a drive of this speed and longest way."""
    place = "rear" if speed_m_s < 0 else "front"
    metres = gate.metres.get(place)
    if gate.verdict == STOPPED:
        return _held(say("the gate would hold it: emergency stop"))
    if gate.verdict == "starting":
        return _held(say("the gate would hold it: it is starting"))
    blocked = "blocked_backward" if speed_m_s < 0 else "blocked_forward"
    if gate.verdict in ("blocked", blocked):
        return _held(_why_held(gate, place, metres))
    if metres is None:
        unseen = say("the gate would let it: no sensor sees that way")
        return Preview(unseen, lets=True, reach_m=distance_m)
    if math.isinf(metres):
        return Preview(say("the gate would let it: nothing in range"), True, distance_m)
    return _towards(gate, metres, distance_m)


def _towards(gate: Gate, metres: float, distance_m: float) -> Preview:
    free_m = max(0.0, metres - (gate.critical_m or 0.0))
    slow_m = gate.slow_m or 0.0
    if distance_m > free_m:
        words = say(
            "the gate would stop it after {reach:.2f} m: obstacle at {metres:.2f} m", reach=free_m, metres=metres
        )
    elif metres - distance_m < slow_m:
        words = say("the gate would slow it down: obstacle at {metres:.2f} m", metres=metres)
    else:
        words = say("the gate would let it: free for {metres:.2f} m", metres=metres)
    return Preview(words, lets=True, reach_m=min(distance_m, free_m))


def _held(words: Words) -> Preview:
    return Preview(words, lets=False, reach_m=0.0)


def _why_held(gate: Gate, place: str, metres: float | None) -> Words:
    if metres is None or gate.states.get(place) in ("silent", "invalid"):
        return say("the gate would hold it: its sensor gives no distance that way")
    return say("the gate would hold it: obstacle at {metres:.2f} m", metres=metres)
