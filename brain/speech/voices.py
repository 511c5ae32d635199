"""What all voices have in common, and the choice of one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from brain.speech.sound import Sound

BACKENDS = ("espeak", "piper", "server")


class Voice(Protocol):
    """Turns text into sound; may take its time, and is used by one thread."""

    def speak(self, text: str, language: str) -> Sound:
        """Return the spoken text; `language` is en or ru.

        Raises:
            SpeechError: it cannot be done now.
        """


def voice(backend: str, model: str) -> Voice:
    """Return one of `BACKENDS`; `model` is a file for piper, and unused otherwise.

    Raises:
        SpeechError: a package, a model or the settings are missing; the words name the fix.
    """
    if backend == "espeak":
        from brain.speech.espeak import EspeakVoice

        return EspeakVoice()
    if backend == "piper":
        from brain.speech.piper import PiperVoice

        return PiperVoice(model)
    from brain.speech.server import ServerVoice

    return ServerVoice()


def language_of(text: str) -> str:
    """Return ru for a text with Cyrillic letters in it, en otherwise."""
    return "ru" if any("а" <= char <= "я" or char == "ё" for char in text.casefold()) else "en"
