"""The tools that only look: what the robot reports, its camera, and the graph.

What comes from the graph comes from anybody: names and values are made printable and bounded.
"""

from __future__ import annotations

import asyncio
import base64
import math
import time
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from agents.refusal import refused
from agents.tools import Call, Camera, Count, Facts, Part, RosName, Seconds, Width, tool
from graph.heavy_types import COMPRESSED_IMAGE, IMAGE
from graph.messages.yaml_text import to_yaml
from graph.pictures.reading import read_picture
from robot.topics import BATTERY, CAMERA, HEAD_STATE, MOCK_POSE, ODOMETRY, SONAR_FRONT, SONAR_REAR
from safety.gate_report import gate_in
from safety.topics import SAFETY_STATE
from text.plain import plain, plain_lines

if TYPE_CHECKING:
    from agents.session import RobotSession
    from graph.data import Sample, TopicRow
    from safety.gate_report import Gate

FRESH_S = 2.5
"""An older state is not one."""
SEEN_WITHIN_S = 5.0
MOST_ROWS = 100
MOST_ELEMENTS = 16
"""Elements of an array that are shown."""
MOST_CHARS = 16_000
LONGEST_NAME = 200


def fresh_gate(session: RobotSession) -> Gate | None:
    """Return what the gate reports now, None if it reports nothing."""
    sample = session.view.newest(SAFETY_STATE, FRESH_S)
    return None if sample is None else gate_in(sample.value)


@tool()
async def look(call: Call) -> Facts:
    """The state of the robot now.

    Nodes, emergency stop, safety gate and why it holds, sonar distances in metres, pose, head, battery, and the
    limits for agents.
    """
    session, view, rules = call.session, call.session.view, call.session.info.agents
    nodes = [
        {"name": node.name, "state": node.state.value, "detail": plain(str(node.detail), 300)}
        for node in list(session.link.nodes.values())[:MOST_ROWS]
    ]
    return {
        "session": session.info.name,
        "hardware": session.info.hardware,
        "nodes": nodes,
        "emergency_stop": {"engaged": session.emergency.engaged, "held_by": session.emergency.holding},
        "gate": gate_fields(fresh_gate(session)),
        "sonar_m": {
            place: _distance(view.newest(topic, FRESH_S))
            for place, topic in (("front", SONAR_FRONT), ("rear", SONAR_REAR))
        },
        "pose": _pose(session),
        "head_deg": _head(view.newest(HEAD_STATE, FRESH_S)),
        "battery": _plain_value(view.newest(BATTERY, 60.0)),
        "approval": call.driving.approval.value,
        "limits": {"max_speed_m_s": rules.max_speed_m_s, "max_distance_m": rules.max_distance_m},
    }


def gate_fields(gate: Gate | None) -> dict[str, object] | None:
    """Return the report of the gate, None without one."""
    if gate is None:
        return None
    return {
        "verdict": plain(gate.verdict, 60),
        "says": plain(gate.message, 300),
        "front_m": _number(gate.metres.get("front")),
        "rear_m": _number(gate.metres.get("rear")),
        "critical_m": _number(gate.critical_m),
        "slow_m": _number(gate.slow_m),
        "obeys": plain(gate.source, LONGEST_NAME),
        "refused": plain(gate.refused, LONGEST_NAME),
    }


@tool()
async def see(call: Call, topic: Camera = None, width: Width = 640) -> tuple[str, Facts]:
    """The newest picture of the robot's camera."""
    session, topic = call.session, topic or CAMERA
    row = session.view.topic(topic)
    kinds = () if row is None else row.type_names
    if not {IMAGE, COMPRESSED_IMAGE} & set(kinds):
        raise refused("nobody publishes pictures on {topic}", topic=topic)
    with session.view.looking_at(topic):
        if not await session.view.until(lambda: session.view.newest(topic, SEEN_WITHIN_S) is not None, SEEN_WITHIN_S):
            raise refused("no picture has come within {seconds:g} s", seconds=SEEN_WITHIN_S)
        sample = session.view.newest(topic, math.inf)
    assert sample is not None
    jpeg, wide, height = await asyncio.to_thread(_as_jpeg, sample, width)
    age_s = max(0.0, time.time() - sample.received_s + sample.age_s)
    facts = {"topic": topic, "width": wide, "height": height, "age_s": round(age_s, 2)}
    return base64.b64encode(jpeg).decode(), {**facts, "bytes": len(jpeg)}


def _as_jpeg(sample: Sample, width: int) -> tuple[bytes, int, int]:
    from graph.pictures.compressed import to_jpeg
    from graph.pictures.pixels import ImageError

    def fit(wide: int, high: int) -> tuple[int, int]:
        share = min(1.0, width / max(1, wide), width / max(1, high))
        return max(1, round(wide * share)), max(1, round(high * share))

    try:
        picture = read_picture(sample.type_name, sample.value, fit)
    except ImageError as error:
        raise refused("the picture cannot be read: {why}", why=str(error)) from None
    height, wide = picture.rgb.shape[:2]
    return to_jpeg(picture.rgb), wide, height


@tool()
async def topics(call: Call, contains: Part = "") -> Facts:
    """The ROS topics, with types and nodes."""
    rows = [row for row in call.session.view.topics if contains in row.name]
    found = [
        {
            "topic": plain(row.name, LONGEST_NAME),
            "types": [plain(name, LONGEST_NAME) for name in row.type_names],
            "published_by": [plain(end.node, LONGEST_NAME) for end in row.published_by[:8]],
            "subscribed_by": [plain(end.node, LONGEST_NAME) for end in row.subscribed_by[:8]],
        }
        for row in rows[:MOST_ROWS]
    ]
    return {"topics": found, "left_out": max(0, len(rows) - MOST_ROWS)}


@tool()
async def graph(call: Call, contains: Part = "") -> Facts:
    """The ROS nodes, with topics, services and actions."""
    rows = [row for row in call.session.view.nodes if contains in row.name]
    found = [
        {
            "node": plain(row.name, LONGEST_NAME),
            "publishes": _names(row.publishes),
            "subscribes": _names(row.subscribes),
            "services": _names(row.services),
            "actions": _names(row.action_servers),
        }
        for row in rows[:MOST_ROWS]
    ]
    return {"nodes": found, "left_out": max(0, len(rows) - MOST_ROWS)}


@tool()
async def echo(call: Call, topic: RosName, count: Count = 1, seconds: Seconds = 3.0) -> Facts:
    """The next messages of a ROS topic, as YAML."""
    view = call.session.view
    row = view.topic(topic)
    if row is None or not (row.publishers or row.own_publishers):
        raise refused("nobody publishes {topic}", topic=topic)
    samples: list[Sample] = []

    def take(sample: Sample) -> None:
        if len(samples) < count:
            samples.append(sample)

    with view.hearing(topic, take):
        await view.until(lambda: len(samples) >= count, seconds)
    messages, room = [], MOST_CHARS
    for sample in samples:
        text = plain_lines(to_yaml(sample.value, MOST_ELEMENTS))[:room]
        messages.append(text)
        room -= len(text)
        if room <= 0:
            break
    return {"topic": topic, "messages": messages, "why_empty": _why_empty(row, messages)}


def _why_empty(row: TopicRow, messages: list[str]) -> str:
    return "" if messages else plain(row.detail or "no message has come in that time", 300)


def _names(names: tuple[str, ...]) -> list[str]:
    return [plain(name, LONGEST_NAME) for name in names[:MOST_ROWS]]


def _number(value: float | None) -> float | str | None:
    """Return a number as JSON knows it, infinity as a word."""
    if value is None or math.isnan(value):
        return None
    return round(value, 3) if math.isfinite(value) else ("inf" if value > 0 else "-inf")


def _distance(sample: Sample | None) -> float | str | None:
    data = None if sample is None else sample.value.get("data")
    return _number(float(data)) if isinstance(data, (int, float)) else None


def _pose(session: RobotSession) -> dict[str, object] | None:
    """Return where the robot takes itself to be; where it is simulated, where it is."""
    odometry = session.view.newest(ODOMETRY, FRESH_S)
    if odometry is None:
        sample = session.view.newest(MOCK_POSE, FRESH_S)
        return None if sample is None else _planar(sample.value.get("pose"))
    pose: Any = odometry.value.get("pose")
    return _planar(pose.get("pose") if isinstance(pose, Mapping) else None)


def _planar(pose: Any) -> dict[str, object] | None:  # noqa: ANN401 - a message as a tree
    """Return place and heading of a geometry_msgs/Pose: x and y in m, yaw in rad."""
    try:
        place, turn = pose["position"], pose["orientation"]
        x, y, z, w = (float(turn[axis]) for axis in "xyzw")
        yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        return {"x_m": _number(float(place["x"])), "y_m": _number(float(place["y"])), "yaw_rad": _number(yaw)}
    except (KeyError, TypeError, ValueError):
        return None


def _head(sample: Sample | None) -> dict[str, object] | None:
    if sample is None:
        return None
    names, positions = sample.value.get("name"), sample.value.get("position")
    if not hasattr(names, "__len__") or not hasattr(positions, "__len__"):
        return None
    pairs = zip(names, positions, strict=False)  # type: ignore[arg-type]
    return {plain(str(name), 40): _number(math.degrees(float(str(at)))) for name, at in pairs}


def _plain_value(sample: Sample | None) -> str | None:
    if sample is None:
        return None
    return plain_lines(to_yaml(sample.value, MOST_ELEMENTS))[:1000]
