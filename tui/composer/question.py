"""A question to a model: what the model gets to know of the robot, and how far its answer has come."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from robot.commands.schema import CommandError, parse_llm
from robot.commands.wrapping import THINK, unwrapped
from robot.topics import LLM_RESULT, ODOMETRY, SONAR_FRONT, SONAR_REAR
from safety.gate_report import gate_in
from safety.topics import SAFETY_STATE
from tui import clock

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from brain.situation import Situation
    from graph.data import Sample
    from robot.commands.schema import Problem
    from robot.motion.odometry import Pose

WATCHED = frozenset({SONAR_FRONT, SONAR_REAR, ODOMETRY, SAFETY_STATE})
"""Only the newest message counts."""
FRESH_S = 3.0
"""What is older is unknown."""


class RobotSenses:
    """Remembers the newest messages of a session: of what the screen sees anyway."""

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

        gate = gate_in(self._fresh(SAFETY_STATE))
        return Situation(
            heard=words,
            front_m=self._distance(SONAR_FRONT),
            rear_m=self._distance(SONAR_REAR),
            pose=self._pose(),
            gate="" if gate is None else gate.message,
            refused=self._refused,
        )

    def _fresh(self, topic: str) -> Mapping[str, Any]:
        """Return the newest message, empty if there is none that is new enough."""
        sample = self._newest.get(topic)
        if sample is None or clock.now() - (sample.received_s - sample.age_s) > FRESH_S:
            return {}
        return sample.value

    def _distance(self, topic: str) -> float | None:
        value = self._fresh(topic).get("data")
        return float(value) if isinstance(value, (int, float)) else None

    def _pose(self) -> Pose | None:
        if not (value := self._fresh(ODOMETRY)):
            return None
        # It imports numpy, which the Composer needs for nothing else.
        from tui.panels.map_scene import pose_in

        found = pose_in(value)
        return None if found is None else found[0]


@dataclass
class ModelQuestion:
    """What was asked, and the answer as far as it has come."""

    words: str
    model: str
    begun_s: float = field(default_factory=time.monotonic)
    """Monotonic clock."""
    refused: tuple[Problem, ...] = ()
    """What was wrong with the first answer, if there is a second."""
    pieces: list[str] = field(default_factory=list)
    """All of the answer that has come, even if only thoughts."""

    def repair(self, _problems: str) -> None:
        """The answer was refused, and another one begins."""
        try:
            parse_llm(self.text)
        except CommandError as error:
            self.refused = error.problems
        self.pieces.clear()

    @property
    def text(self) -> str:
        """The JSON so far, without what models like to put around it."""
        text = unwrapped("".join(self.pieces), whole=False).strip()
        return "" if text.startswith(THINK) else text
