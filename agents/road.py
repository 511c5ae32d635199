"""The road from /llm_raw_json to the wheels: is it the one that passes the safety gate?

An agent drives only where exactly one node carries out its commands and ends them by itself, and
where only the gate hears what that node says. In doubt it does not drive.
"""

from __future__ import annotations

import asyncio
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from agents.looking import fresh_gate
from agents.refusal import refused
from graph.observer.requests import ReadParameters
from robot.topics import DRIVE, DRIVE_SAFE, LLM_RAW_JSON

if TYPE_CHECKING:
    from agents.session import RobotSession
    from graph.data import EndpointInfo
    from safety.gate_report import Gate

ANSWER_WITHIN_S = 3.0
KNOWN_WITHIN_S = 3.0
REPEAT_FOR_S = "repeat_for_s"
LONGEST_S = 60.0
UNKNOWN = "_UNKNOWN_"
"""In the names of a node whose endpoint is known but whose name is not yet (rmw)."""


@dataclass(frozen=True)
class Road:
    """What is between an agent and the wheels."""

    parser: str
    """The node that carries out what an agent sends."""
    repeat_for_s: float
    """How long it repeats a drive before it stops; 0 if only the head is asked for."""
    gate: Gate | None = None
    """What the gate reports now."""

    @property
    def way(self) -> tuple[str, float]:
        """What a person was asked about: who drives, and for how long."""
        return self.parser, self.repeat_for_s


async def road_of(session: RobotSession, *, wheels: bool) -> Road:
    """Return the road; `wheels`: whether the robot is to drive, which needs more.

    Raises:
        RefusedError: if something is missing, or in the way of safety.
    """
    view = session.view
    if view.error:
        raise refused("the robot cannot be seen: {why}", why=view.error)
    await view.until(lambda: _known(session) and bool(_ends(session, LLM_RAW_JSON)[1]), KNOWN_WITHIN_S)
    if not _known(session):
        raise refused("not all nodes between the agent and the wheels are known by name")
    parsers = _nodes(_ends(session, LLM_RAW_JSON)[1])
    if not parsers:
        raise refused("nothing carries out commands: no node hears {topic}", topic=LLM_RAW_JSON)
    if len(parsers) > 1:
        nodes = ", ".join(sorted(parsers))
        raise refused("several nodes would carry out the commands: {nodes}", nodes=nodes)
    (parser,) = parsers
    if not wheels:
        return Road(parser, 0.0)
    gate = await _gate_of(session)
    repeat_for_s = await _repeats_for_s(session, parser)
    if not 0 < repeat_for_s <= LONGEST_S:
        raise refused("{node} does not end a drive by itself: start it with `repeat_for_s` above 0", node=parser)
    return Road(parser, repeat_for_s, gate)


async def _gate_of(session: RobotSession) -> Gate:
    await session.view.until(lambda: fresh_gate(session) is not None, KNOWN_WITHIN_S)
    gates = _nodes(_ends(session, DRIVE_SAFE)[0])
    if not gates:
        raise refused("no safety gate: nobody publishes {topic}", topic=DRIVE_SAFE)
    if len(gates) > 1:
        nodes = ", ".join(sorted(gates))
        raise refused("{nodes} all publish {topic}: only a gate may", nodes=nodes, topic=DRIVE_SAFE)
    past = _nodes(_ends(session, DRIVE)[1]) - gates
    if past:
        nodes = ", ".join(sorted(past))
        raise refused("{nodes} would drive past the safety gate: it hears {topic}", nodes=nodes, topic=DRIVE)
    gate = fresh_gate(session)
    if gate is None:
        raise refused("the safety gate reports nothing")
    return gate


async def _repeats_for_s(session: RobotSession, node: str) -> float:
    asked = session.observer.ask(ReadParameters(node, ANSWER_WITHIN_S))
    result = await asyncio.wrap_future(asked)
    if result.error:
        raise refused("{node} does not say how long it drives: {why}", node=node, why=result.error)
    value = next((row.value for row in result.parameters if row.name == REPEAT_FOR_S), 0.0)
    seconds = float(value) if isinstance(value, (int, float)) else 0.0
    return seconds if math.isfinite(seconds) else 0.0


def _ends(session: RobotSession, topic: str) -> tuple[tuple[EndpointInfo, ...], tuple[EndpointInfo, ...]]:
    row = session.view.topic(topic)
    return ((), ()) if row is None else (row.published_by, row.subscribed_by)


def _nodes(ends: tuple[EndpointInfo, ...]) -> set[str]:
    """Return the nodes, without tools that only listen: their names begin with an underscore."""
    names = {end.node for end in ends}
    return {name for name in names if not name.rpartition("/")[2].startswith("_")}


def _known(session: RobotSession) -> bool:
    """Whether all nodes on the road have told their names: until then, any may be anything."""
    ends = [end for topic in (LLM_RAW_JSON, DRIVE, DRIVE_SAFE) for end in sum(_ends(session, topic), ())]
    return not any(UNKNOWN in end.node for end in ends)
