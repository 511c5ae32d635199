"""What all recognisers of speech have in common, and the choice of one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from brain.speech.faults import SpeechError
from text.sentences import say

if TYPE_CHECKING:
    from brain.speech.sound import Sound

BACKENDS = ("sphinx", "vosk", "sherpa", "server")


class Recogniser(Protocol):
    """Turns whole utterances into words; may take its time, and is used by one thread."""

    def transcribe(self, said: Sound) -> str:
        """Return the words, empty if there are none.

        Raises:
            SpeechError: it cannot be done now.
        """


def recogniser(backend: str, language: str, model: str) -> Recogniser:
    """Return one of `BACKENDS`; `model` is a folder for vosk and sherpa, and unused otherwise.

    Raises:
        SpeechError: a package, a model or the settings are missing; the words name the fix.
    """
    if backend == "sphinx":
        from brain.speech.sphinx import SphinxRecogniser

        if language != "en":
            raise SpeechError(
                say("pocketsphinx knows only English"),
                say("take backend:=vosk and model:=FOLDER of a model of this language"),
            )
        return SphinxRecogniser()
    if backend == "vosk":
        from brain.speech.vosk import VoskRecogniser

        return VoskRecogniser(model)
    if backend == "sherpa":
        from brain.speech.sherpa import SherpaRecogniser

        return SherpaRecogniser(model)
    from brain.speech.server import ServerRecogniser

    return ServerRecogniser(language)
