"""The voices, and the choice of one.

eSpeak NG knows a hundred languages without further ado: `brain.speech.espeak`. Piper is a natural voice, by a voice
file of the user's. Voices: https://huggingface.co/rhasspy/piper-voices, an .onnx with its .onnx.json beside it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from brain.speech.espeak import LONGEST_TEXT, EspeakVoice
from brain.speech.faults import SpeechError, missing
from brain.speech.sound import Sound
from text.sentences import say

if TYPE_CHECKING:
    from typing import Any

BACKENDS = ("espeak", "piper")


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
        SpeechError: a package or a model is missing; the words name the fix.
    """
    return PiperVoice(model) if backend == "piper" else EspeakVoice()


def language_of(text: str) -> str:
    """Return ru for a text with Cyrillic letters in it, en otherwise."""
    return "ru" if any("а" <= char <= "я" or char == "ё" for char in text.casefold()) else "en"


class PiperVoice:
    """Speaks in the language of its file.

    Raises:
        SpeechError: the package or the voice is missing.
    """

    def __init__(self, model: str) -> None:
        try:
            import piper
        except (ImportError, OSError):
            raise missing("piper-tts", "piper-tts") from None
        path = Path(model).expanduser()
        if not model or not path.is_file():
            words = say("{path}: there is no such voice", path=model or "-")
            raise SpeechError(words, say("set model:=VOICE.onnx"))
        try:
            self._voice: Any = piper.PiperVoice.load(path)
        except Exception:  # noqa: BLE001 - ONNX and JSON raise errors of their own
            words = say("{path}: is not a {what} model", path=str(path), what="piper")
            raise SpeechError(words, say("set model:=VOICE.onnx")) from None

    def speak(self, text: str, _language: str) -> Sound:
        """Return the spoken text, cut to `LONGEST_TEXT`."""
        chunks = list(self._voice.synthesize(text[:LONGEST_TEXT]))
        rate_hz = chunks[0].sample_rate if chunks else 22_050
        return Sound(b"".join(chunk.audio_int16_bytes for chunk in chunks), rate_hz)
