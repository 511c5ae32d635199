"""Vosk: recognises speech of some twenty languages offline, by a model folder of the user's.

Models: https://alphacephei.com/vosk/models, for example vosk-model-small-ru-0.22, 45 MB.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from brain.speech.faults import SpeechError, missing
from brain.speech.folders import folder_of
from robot.sound import RATE_HZ
from text.nested import read_json
from text.sentences import say

if TYPE_CHECKING:
    from brain.speech.sound import Sound

_WARNINGS = -1


class VoskRecogniser:
    """Hears whatever the model knows.

    Raises:
        SpeechError: the package or the model is missing.
    """

    def __init__(self, model: str) -> None:
        try:
            import vosk
        except (ImportError, OSError):
            raise missing("vosk", "vosk") from None
        folder = folder_of(model, "vosk")
        vosk.SetLogLevel(_WARNINGS)
        try:
            self._recogniser = vosk.KaldiRecognizer(vosk.Model(str(folder)), RATE_HZ)
        except Exception:  # noqa: BLE001 - that is what it raises
            words = say("{path}: is not a {what} model", path=str(folder), what="vosk")
            raise SpeechError(words, say("set model:=FOLDER")) from None

    def transcribe(self, said: Sound) -> str:
        """Return the words, empty if there are none."""
        self._recogniser.AcceptWaveform(said.at(RATE_HZ).pcm)
        found = read_json(self._recogniser.FinalResult())
        return str(found.get("text", "")).strip()
