"""What the model gets to know of the robot: the newest of what the screen sees anyway."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robot.safety.gate_report import gate_in
from robot.topics import LLM_RESULT, ODOMETRY, SAFETY_STATE, SONAR_FRONT, SONAR_REAR
from tui import clock

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from brain.situation import Situation
    from graph.data import Sample
    from robot.motion.odometry import Pose

WATCHED = frozenset({SONAR_FRONT, SONAR_REAR, ODOMETRY, SAFETY_STATE})
"""Only the newest message counts."""
FRESH_S = 3.0
"""What is older is unknown."""


class RobotSenses:
    """Remembers the newest messages of a session."""

    def __init__(self) -> None:
        self._newest: dict[str, Sample] = {}
        self._refused = ""

    def see(self, samples: Mapping[str, Sequence[Sample]]) -> None:
        from brain.situation import refusal

        for topic in WATCHED & samples.keys():
            if samples[topic]:
                self._newest[topic] = samples[topic][-1]
        for sample in samples.get(LLM_RESULT, ()):
            self._refused = refusal(str(sample.value.get("data", "")), self._refused)

    def situation(self, words: str) -> Situation:
        """Return what is known now, and what a person says."""
        from brain.situation import Situation

        return Situation(
            heard=words,
            front_m=self._distance(SONAR_FRONT),
            rear_m=self._distance(SONAR_REAR),
            pose=self._pose(),
            gate=self._gate(),
            refused=self._refused,
        )

    def _fresh(self, topic: str) -> Sample | None:
        sample = self._newest.get(topic)
        if sample is None or clock.now() - (sample.received_s - sample.age_s) > FRESH_S:
            return None
        return sample

    def _distance(self, topic: str) -> float | None:
        sample = self._fresh(topic)
        value: Any = None if sample is None else sample.value.get("data")
        return float(value) if isinstance(value, (int, float)) else None

    def _pose(self) -> Pose | None:
        sample = self._fresh(ODOMETRY)
        if sample is None:
            return None
        # It imports numpy, which the Composer needs for nothing else.
        from tui.panels.map_scene import pose_in

        found = pose_in(sample.value)
        return None if found is None else found[0]

    def _gate(self) -> str:
        sample = self._fresh(SAFETY_STATE)
        gate = None if sample is None else gate_in(sample.value)
        return "" if gate is None else gate.message
