"""The words that drive the robot, in Russian and in English."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass


@dataclass(frozen=True)
class DriveSetpoint:
    """A command to the chassis."""

    speed_m_s: float
    """Speed of the rear axle, negative backwards."""
    steering_rad: float
    """Angle of the front wheels, + is left."""


STOP = DriveSetpoint(0.0, 0.0)

_SETPOINTS = (
    DriveSetpoint(0.5, 0.0),
    DriveSetpoint(0.3, 0.5),
    DriveSetpoint(0.3, -0.5),
    DriveSetpoint(-0.3, 0.0),
    STOP,
)

WORDS: dict[str, tuple[str, ...]] = {
    "ru": ("вперед", "налево", "направо", "назад", "стоп"),
    "en": ("forward", "left", "right", "back", "stop"),
}
"""Language code to its words, in the same order: forward, left, right, back, stop."""

_MEANING = {
    word: setpoint
    for words in WORDS.values()
    for word, setpoint in zip(words, _SETPOINTS, strict=True)
}


def parse_word(text: str) -> DriveSetpoint | None:
    """Return what a word of either language commands, None if it is no such word.

    Case, surrounding blanks, a final full stop or exclamation mark, and ё for е do not matter.
    """
    word = unicodedata.normalize("NFC", text).strip().rstrip("!.").strip()
    return _MEANING.get(word.casefold().replace("ё", "е"))
