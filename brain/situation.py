"""What the robot's brain gets to read before it answers: its senses in words, the talk so far.

The words are English whatever the screen speaks: they are for the model, and every model reads it.
What was heard comes last, and is marked as what it is: somebody's words.
"""

from __future__ import annotations

import base64
import math
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from text.nested import read_json

if TYPE_CHECKING:
    from brain.client import Message
    from robot.motion.odometry import Pose

LONGEST_HEARD = 2000
"""Characters of what was heard."""
_LONGEST_REASON = 300


@dataclass(frozen=True)
class Situation:
    """What the senses say at the time of a question; None is unknown."""

    heard: str
    front_m: float | None = None
    """inf: nothing in range; nan: no valid reading (REP-117)."""
    rear_m: float | None = None
    pose: Pose | None = None
    """By the odometry."""
    gate: str = ""
    """What the gate says of itself: what is blocked, and why."""
    refused: str = ""
    """What became of the last commands, if they were refused."""
    seen: str = ""
    """A description of the newest picture."""
    picture: bytes = b""
    """The newest picture as a JPEG, for a model with vision."""

    def message(self) -> Message:
        said = f'Somebody says: "{self.heard[:LONGEST_HEARD]}"'
        text = f"{self.senses()}\n{said}"
        if not self.picture:
            return {"role": "user", "content": text}
        parts: list[dict[str, Any]] = [{"type": "text", "text": text}, picture_part(self.picture)]
        return {"role": "user", "content": parts}

    def senses(self) -> str:
        """Return what the senses say, a line each."""
        lines = [f"Distance ahead: {_metres(self.front_m)}", f"Distance behind: {_metres(self.rear_m)}"]
        if self.pose is not None:
            at = f"x {self.pose.x_m:.2f} m, y {self.pose.y_m:.2f} m"
            heading_deg = math.degrees(self.pose.heading_rad)
            lines.append(f"Position: {at}, heading {heading_deg:.0f} deg, + is left")
        for name, words in (("Safety gate", self.gate), ("Your last commands", self.refused), ("Camera", self.seen)):
            if words:
                lines.append(f"{name}: {words[:_LONGEST_REASON]}")
        return "\n".join(lines)


class Memory:
    """The talk so far, bounded: the newest turns, and not too many characters of them."""

    def __init__(self, turns: int = 8, characters: int = 8000) -> None:
        self._turns: deque[tuple[str, str]] = deque(maxlen=turns)
        self._most = characters

    def add(self, heard: str, answer: str) -> None:
        """Remember a turn: what was heard, and the JSON that was answered."""
        self._turns.append((heard[:LONGEST_HEARD], answer))
        while len(self._turns) > 1 and self._size() > self._most:
            self._turns.popleft()

    def forget(self) -> None:
        """Begin a new talk."""
        self._turns.clear()

    def messages(self) -> list[Message]:
        """Return the talk as messages; of the senses only what was heard is kept."""
        return [
            message
            for heard, answer in self._turns
            for message in (
                {"role": "user", "content": f'Somebody says: "{heard}"'},
                {"role": "assistant", "content": answer},
            )
        ]

    def _size(self) -> int:
        return sum(len(heard) + len(answer) for heard, answer in self._turns)


def conversation(prompt: str, memory: Memory, situation: Situation) -> list[Message]:
    """Return all messages of a question: the prompt, the talk so far, the situation."""
    return [{"role": "system", "content": prompt}, *memory.messages(), situation.message()]


def refusal(report: str, before: str = "") -> str:
    """Return what became of the last commands if they were refused, by a message on /llm_result.

    `before` is what is known from the messages before it.
    """
    try:
        found = read_json(report)
        event = found["event"]
    except (ValueError, KeyError, TypeError):
        return before
    if event == "accepted":
        return ""
    if event == "refused":
        return f"refused: {found.get('problems')}"
    if event == "head" and found.get("sum") != 1:
        return f"the head did not turn to pan {found.get('pan')}"
    return before


def picture_part(jpeg: bytes) -> dict[str, Any]:
    """Return a picture as a part of a message, inside it and not by an address."""
    url = f"data:image/jpeg;base64,{base64.b64encode(jpeg).decode()}"
    return {"type": "image_url", "image_url": {"url": url}}


def _metres(distance_m: float | None) -> str:
    if distance_m is None:
        return "unknown"
    if math.isnan(distance_m):
        return "no valid reading"
    if math.isinf(distance_m):
        return "nothing in range" if distance_m > 0 else "too close to measure"
    return f"{distance_m:.2f} m"
