"""What the graph, the gate and the nodes say of the emergency stop."""

from __future__ import annotations

from typing import Any

from graph.data import GraphUpdate, NodeRow, Sample
from safety.topics import EMERGENCY_STATE, EMERGENCY_STOP, SAFETY_STATE
from tests.tui.recorded import lesson_update, sample
from tui.emergency.state import TOPIC_TYPE

GATE, CHASSIS = "/safety_stop", "/chassis"


def said(engaged: bool, at_s: float) -> GraphUpdate:
    """The graph with one message on the topic of the stop."""
    one = Sample(EMERGENCY_STOP, TOPIC_TYPE, at_s, 0.0, 4, {"data": engaged})
    return lesson_update(samples={EMERGENCY_STOP: (one,)})


def held(level: bytes, words: str) -> GraphUpdate:
    """The graph with one word of the safety node."""
    status = [{"level": level, "name": "safety_stop", "message": words, "values": []}]
    one = sample(SAFETY_STATE, "diagnostic_msgs/msg/DiagnosticArray", {"status": status})
    return lesson_update(samples={SAFETY_STATE: (one,)})


def gate_says(verdict: str, at_s: float) -> GraphUpdate:
    """The graph with one verdict of the gate, as the safety node words it."""
    values = [{"key": "verdict", "value": verdict}]
    status: list[dict[str, Any]] = [{"level": b"\x02", "name": "safety_stop", "message": "held", "values": values}]
    kind = "diagnostic_msgs/msg/DiagnosticArray"
    one = Sample(SAFETY_STATE, kind, at_s, 0.0, 120, {"status": status})
    return lesson_update(samples={SAFETY_STATE: (one,)})


def word(node: str, engaged: bool, at_s: float, *, since_s: float | None = None, **more: str) -> Sample:
    """What one node says of the stop that it obeys."""
    values = {"engaged": str(engaged).lower(), **more}
    values["since"] = str(at_s if since_s is None else since_s)
    pairs = [{"key": key, "value": value} for key, value in values.items()]
    status = [{"level": b"\x02" if engaged else b"\x00", "name": node, "values": pairs}]
    return Sample(EMERGENCY_STATE, "diagnostic_msgs/msg/DiagnosticArray", at_s, 0.0, 120, {"status": status})


def obeyed(*words: Sample, at_s: float, **more: Any) -> GraphUpdate:
    nodes = (NodeRow(GATE), NodeRow(CHASSIS))
    samples = {EMERGENCY_STATE: words, **more.pop("samples", {})}
    return lesson_update(samples=samples, nodes=nodes, time_s=at_s, **more)
