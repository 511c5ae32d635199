"""Piper: a natural voice that needs no network, by a voice file of the user's.

Voices: https://huggingface.co/rhasspy/piper-voices, an .onnx with its .onnx.json beside it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from brain.speech.espeak import LONGEST_TEXT
from brain.speech.faults import SpeechError, missing
from brain.speech.sound import Sound
from text.sentences import say

if TYPE_CHECKING:
    from typing import Any


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
