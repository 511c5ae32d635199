"""The recognisers of speech, and the choice of one.

pocketsphinx hears the robot's commands in English without further ado: `brain.speech.sphinx`. Vosk knows some
twenty languages, by a model folder of the user's.
Models: https://alphacephei.com/vosk/models, for example vosk-model-small-ru-0.22, 45 MB.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from brain.speech.faults import SpeechError, missing
from robot.sound import RATE_HZ
from text.nested import read_json
from text.sentences import say

if TYPE_CHECKING:
    from brain.speech.sound import Sound

BACKENDS = ("sphinx", "vosk")
_WARNINGS = -1


class Recogniser(Protocol):
    """Turns whole utterances into words; may take its time, and is used by one thread."""

    def transcribe(self, said: Sound) -> str:
        """Return the words, empty if there are none.

        Raises:
            SpeechError: it cannot be done now.
        """


def recogniser(backend: str, language: str, model: str) -> Recogniser:
    """Return one of `BACKENDS`; `model` is a folder for vosk, and unused otherwise.

    Raises:
        SpeechError: a package or a model is missing; the words name the fix.
    """
    if backend == "vosk":
        return VoskRecogniser(model)
    if language != "en":
        raise SpeechError(
            say("pocketsphinx knows only English"),
            say("take backend:=vosk and model:=FOLDER of a model of this language"),
        )
    from brain.speech.sphinx import SphinxRecogniser

    return SphinxRecogniser()


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
        if not model:
            words = say("{what} needs a model of the language", what="vosk")
            raise SpeechError(words, say("set model:=FOLDER"))
        folder = Path(model).expanduser()
        if not folder.is_dir():
            words = say("{path}: there is no such folder", path=str(folder))
            raise SpeechError(words, say("set model:=FOLDER"))
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
