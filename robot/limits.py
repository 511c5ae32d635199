"""How far the robot may be asked to go, whoever asks."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """A closed range and its unit."""

    low: float
    high: float
    unit: str

    def __contains__(self, value: object) -> bool:
        """Whether a number lies inside; nan never does."""
        return isinstance(value, (int, float)) and self.low <= value <= self.high


SPEED = Limits(-0.5, 0.5, "m/s")
STEERING = Limits(-0.5, 0.5, "rad")
HEAD_ANGLE = Limits(-90, 90, "deg")
"""Pan and tilt, in whole degrees."""
MAX_COMMANDS = 32
"""Commands in one response of an LLM."""
MAX_BYTES = 64 * 1024
"""Size of one response of an LLM."""
