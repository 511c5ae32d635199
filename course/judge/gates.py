"""The check of the safety gate: the only road to the wheels, closed before an obstacle."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

from course.judge.evidence import MET, Observation, is_decks, same_name
from course.judge.missing import no_messages, no_topic, wrong_type
from text.sentences import say

if TYPE_CHECKING:
    from course.judge.evidence import Evidence
    from launcher.profile.steps.checks import GateCheck

STILL_M_S = 1e-3
LATE_S = 3.0
"""How much longer the first message of a gate is waited for."""
TYPE = "ackermann_msgs/msg/AckermannDriveStamped"
DISTANCE_TYPE = "std_msgs/msg/Float32"


async def gate(check: GateCheck, evidence: Evidence) -> Observation:
    """Watch the gate for its whole time, and a little longer if nothing has come by then."""
    began_s = time.time()
    observation = _so_far(check, evidence, began_s)
    while not (observation.final or evidence.ended):
        took_s = time.time() - began_s
        if took_s >= check.over + (0 if observation.met else LATE_S):
            break
        await evidence.wait(0.2)
        observation = _so_far(check, evidence, began_s)
    return observation


def _so_far(check: GateCheck, evidence: Evidence, since_s: float) -> Observation:
    """So far nobody else publishes the gate's topic, and no forward speed was wrong."""
    row = evidence.topic(check.gate)
    if row is None or not row.published_by:
        return no_topic(evidence, check.gate)
    strangers = [
        end.node for end in row.published_by if not same_name(end.node, check.from_node) and not is_decks(end.node)
    ]
    if strangers:
        return Observation(
            met=False,
            final=True,
            seen=say("{topic} is published by {nodes}", topic=check.gate, nodes=", ".join(strangers)),
            look=say("A brain says what it wants on /drive; only the gate decides."),
        )
    messages = evidence.messages(check.gate, since_s)
    if messages and messages[-1].type_name != TYPE:
        return wrong_type(check.gate, TYPE, (messages[-1].type_name,))
    distances = [
        (message.time_s, float(str(message.value.get("data", math.nan))))
        for message in evidence.messages(check.distance, 0.0)
    ]
    for message in messages:
        if message.type_name != TYPE:
            continue
        speed = float(str(message.value["drive"]["speed"]))  # type: ignore[index,call-overload]
        if speed > STILL_M_S and _near(distances, message.time_s, check):
            return Observation(
                met=False,
                final=True,
                seen=say(
                    "{topic} lets {speed} m/s through with an obstacle nearer than {limit} m",
                    topic=check.gate,
                    speed=f"{speed:.2f}",
                    limit=f"{check.stop_below:g}",
                ),
            )
    for topic, type_name, heard in ((check.gate, TYPE, messages), (check.distance, DISTANCE_TYPE, distances)):
        if not heard:
            return no_messages(evidence, topic, type_name)
    return MET


def _near(distances: list[tuple[float, float]], time_s: float, check: GateCheck) -> bool:
    """Whether all that the sonar said in the time to react, and before it, was too near."""
    before = [metres for when_s, metres in distances if when_s <= time_s - check.settle]
    during = [metres for when_s, metres in distances if time_s - check.settle < when_s <= time_s]
    latest = [*before[-1:], *during]
    return bool(before) and all(metres < check.stop_below for metres in latest)
