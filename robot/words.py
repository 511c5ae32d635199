"""The words that drive the robot, in Russian and in English, and how they are spoken."""

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

_MEANING = {word: setpoint for words in WORDS.values() for word, setpoint in zip(words, _SETPOINTS, strict=True)}


def parse_word(text: str) -> DriveSetpoint | None:
    """Return what a word of either language commands, None if it is no such word.

    Case, surrounding blanks, a final full stop or exclamation mark, and ё for е do not matter.
    """
    word = unicodedata.normalize("NFC", text).strip().rstrip("!.").strip()
    return _MEANING.get(word.casefold().replace("ё", "е"))


WAKE_WORDS = {"en": "robot", "ru": "робот"}
"""Language code to the word that begins whatever is said to the robot."""
STOP_WORDS = {language: words[-1] for language, words in WORDS.items()}
"""Language code to the word that needs no wake word before it."""

SPOKEN: dict[str, dict[str, tuple[str, ...]]] = {
    "en": {
        "forward": ("forward", "go forward", "drive forward", "move forward"),
        "left": ("left", "turn left", "go left"),
        "right": ("right", "turn right", "go right"),
        "back": ("back", "go back", "drive back", "move back"),
        "stop": ("stop", "stop now"),
    },
    "ru": {
        "вперед": ("вперед", "поезжай вперед", "езжай вперед"),
        "налево": ("налево", "поверни налево", "езжай налево"),
        "направо": ("направо", "поверни направо", "езжай направо"),
        "назад": ("назад", "езжай назад", "сдай назад"),
        "стоп": ("стоп", "стой", "остановись"),
    },
}
"""Language code to what may be said for each of its words."""

LOOK: dict[str, tuple[str, ...]] = {
    "en": ("look around", "look round", "have a look around", "have a look round"),
    "ru": ("осмотрись", "посмотри вокруг"),
}
"""Language code to the requests to look round and drive on, which are no words of `WORDS`."""

_SAID = {said: word for words in SPOKEN.values() for word, ways in words.items() for said in ways} | {
    said: ways[0] for ways in LOOK.values() for said in ways
}


def parse_spoken(text: str) -> str | None:
    """Return the word of `WORDS`, or the first request of `LOOK`, that somebody said to the robot.

    None for everything else. A microphone hears whoever talks near it, and that must not move the
    robot: all but a stop has to begin with the wake word, and nothing may follow. Punctuation and
    case do not matter.
    """
    called = addressed(text)
    meant = _SAID.get(" ".join(_words_of(text)) if called is None else called)
    return meant if called is not None or meant in STOP_WORDS.values() else None


def addressed(text: str) -> str | None:
    """Return what follows the wake word, without punctuation; None if it is not the beginning."""
    words = _words_of(text)
    return " ".join(words[1:]) if words and words[0] in WAKE_WORDS.values() else None


def _words_of(text: str) -> list[str]:
    folded = unicodedata.normalize("NFC", text).casefold().replace("ё", "е")
    return "".join(char if char.isalnum() else " " for char in folded).split()
