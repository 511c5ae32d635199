"""What the model gets to know of the robot, gathered from the topics."""

from __future__ import annotations

import time
from typing import Generic, TypeVar

from diagnostic_msgs.msg import DiagnosticArray
from std_msgs.msg import Float32, String

from brain.situation import Situation, refusal
from nodes.parts.node import DEPTH, LessonNode, SensorListener
from nodes.parts.odometry import OdometryListener
from robot.topics import LLM_RESULT, SONAR_REAR, VLM_DESCRIPTION
from safety.topics import SAFETY_STATE

T = TypeVar("T")
_GATE_S, _POSE_S, _SEEN_S = 3.0, 2.0, 30.0
"""How long each is passed on: an older one counts as unknown."""


class _Newest(Generic[T]):
    """The newest value, as long as it is fresh."""

    def __init__(self, fresh_s: float) -> None:
        self._fresh_s = fresh_s
        self._value: T | None = None
        self._at_s = 0.0

    def put(self, value: T) -> None:
        self._value, self._at_s = value, time.monotonic()

    def get(self) -> T | None:
        return self._value if time.monotonic() - self._at_s <= self._fresh_s else None


class Senses:
    """Listens to what the brain does not need for its rules."""

    def __init__(self, node: LessonNode, stale_after_s: float) -> None:
        self._rear: _Newest[float] = _Newest(stale_after_s)
        self._gate: _Newest[str] = _Newest(_GATE_S)
        self._seen: _Newest[str] = _Newest(_SEEN_S)
        self._refused = ""
        self._odometry = OdometryListener(node)
        SensorListener(node, Float32, SONAR_REAR, self._hear_rear)
        node.create_subscription(DiagnosticArray, SAFETY_STATE, self._hear_gate, DEPTH)
        node.create_subscription(String, LLM_RESULT, self._hear_result, DEPTH)
        node.create_subscription(String, VLM_DESCRIPTION, self._hear_description, DEPTH)

    def situation(self, heard: str, front_m: float | None, picture: bytes = b"") -> Situation:
        """Return what the senses say now; `front_m` is None if it is too old."""
        return Situation(
            heard=heard,
            front_m=front_m,
            rear_m=self._rear.get(),
            pose=self._odometry.pose if self._odometry.age_s <= _POSE_S else None,
            gate=self._gate.get() or "",
            refused=self._refused,
            seen=self._seen.get() or "",
            picture=picture,
        )

    def _hear_rear(self, message: Float32) -> None:
        self._rear.put(message.data)

    def _hear_description(self, message: String) -> None:
        self._seen.put(message.data)

    def _hear_gate(self, message: DiagnosticArray) -> None:
        if message.status:
            self._gate.put(message.status[0].message)

    def _hear_result(self, message: String) -> None:
        self._refused = refusal(message.data, self._refused)
