"""Decides what the lesson's brain does after hearing a voice: the part that needs no ROS.

It takes the place of an LLM. It never drives forward without a clear view ahead.
"""

from __future__ import annotations

from enum import Enum

from robot.safety.distance import RangeState
from robot.words import STOP, DriveSetpoint, parse_word

CALL = "voice_command:"
"""Prefix that the mock microphone puts before the words."""
_STOPS = frozenset(("halt", "freeze", "стой", "стоять", "остановись", "остановитесь"))
"""Other words for stop, which people shout."""
_PUNCTUATION = ".,;:!?…\"'«»()-"


class Decision(Enum):
    """The reaction to what was heard."""

    LOOK_AND_GO = "look and go"
    """Turn the head, drive forward."""
    OBSTACLE = "obstacle"
    """Stop: an obstacle is near."""
    BLIND = "blind"
    """Stop: the distance is unknown."""
    OBEY = "obey"
    """Obey the word: it is a drive command, and safe now."""


def spoken(sound: bytes) -> str:
    """The words in the mock microphone's bytes; invalid UTF-8 is replaced."""
    text = sound.decode("utf-8", "replace").strip()
    return text[len(CALL) :].strip() if text.casefold().startswith(CALL) else text


def asks_to_stop(words: str) -> bool:
    """Whether the word for stop is among these: it is obeyed without waiting for a model.

    So "do not stop" stops as well: that is the safe mistake.
    """
    spoken_words = (word.strip(_PUNCTUATION).casefold() for word in words.split())
    return any(word in _STOPS or parse_word(word) == STOP for word in spoken_words)


def decide(order: DriveSetpoint | None, front: RangeState) -> Decision:
    """Decide by the order, if there is one, and by the sonar ahead.

    Any request that is not a drive command is answered by looking around and driving on.
    """
    if order is not None and order.speed_m_s <= 0:
        return Decision.OBEY
    if front == RangeState.CLOSE:
        return Decision.OBSTACLE
    if front != RangeState.FREE:
        return Decision.BLIND
    return Decision.OBEY if order is not None else Decision.LOOK_AND_GO
