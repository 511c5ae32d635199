"""What the lesson's brain decides when it has heard a voice: the part that needs no ROS.

It stands where an LLM will be asked. It never drives forward into what it does not see.
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING

from robot.safety.distance import Sight

if TYPE_CHECKING:
    from robot.words import DriveSetpoint

CALL = "voice_command:"
"""What the mock microphone puts before the words."""


class Decision(Enum):
    """What to do about what was heard."""

    LOOK_AND_GO = "look and go"
    """Turn the head, drive forward."""
    OBSTACLE = "obstacle"
    """Stop: something is near."""
    BLIND = "blind"
    """Stop: the distance is not known."""
    OBEY = "obey"
    """Do what the word says: it was a word that drives, and one that is safe now."""


def spoken(sound: bytes) -> str:
    """The words in the bytes of the mock microphone; broken UTF-8 is replaced."""
    text = sound.decode("utf-8", "replace").strip()
    return text[len(CALL) :].strip() if text.casefold().startswith(CALL) else text


def decide(order: DriveSetpoint | None, front: Sight) -> Decision:
    """Decide by what was ordered, if anything, and by the look ahead.

    Any request that is no order is answered by looking round and driving on.
    """
    if order is not None and order.speed_m_s <= 0:
        return Decision.OBEY
    if front == Sight.CLOSE:
        return Decision.OBSTACLE
    if front != Sight.FREE:
        return Decision.BLIND
    return Decision.OBEY if order is not None else Decision.LOOK_AND_GO
