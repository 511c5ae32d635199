"""sherpa-onnx: recognises speech offline, by a model folder of the user's.

Models: https://k2-fsa.github.io/sherpa/onnx/pretrained_models, those for whole utterances: a
transducer (encoder, decoder, joiner), Whisper (encoder, decoder) or CTC of NeMo (model).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from brain.speech.faults import SpeechError, missing
from brain.speech.folders import folder_of, one_file
from robot.sound import RATE_HZ, samples_of
from text.sentences import say

if TYPE_CHECKING:
    from pathlib import Path

    from brain.speech.sound import Sound

_FULL = 32768.0
_THREADS = 2


class SherpaRecogniser:
    """Hears whatever the model knows.

    Raises:
        SpeechError: the package or the model is missing.
    """

    def __init__(self, model: str) -> None:
        try:
            import sherpa_onnx
        except (ImportError, OSError):
            raise missing("sherpa-onnx", "sherpa-onnx") from None
        folder = folder_of(model, "sherpa-onnx")
        try:
            self._recogniser = _load(sherpa_onnx.OfflineRecognizer, folder)
        except (RuntimeError, ValueError, TypeError):
            self._recogniser = None
        if self._recogniser is None:
            words = say("{path}: is not a {what} model", path=str(folder), what="sherpa-onnx")
            raise SpeechError(words, say("set model:=FOLDER"))

    def transcribe(self, said: Sound) -> str:
        """Return the words, empty if there are none."""
        samples = samples_of(said.at(RATE_HZ).pcm).astype(np.float32) / _FULL
        stream = self._recogniser.create_stream()
        stream.accept_waveform(RATE_HZ, samples)
        self._recogniser.decode_stream(stream)
        return str(stream.result.text).strip()


def _load(kinds: Any, folder: Path) -> Any:  # noqa: ANN401 - without types
    """Return the recogniser of the files that are there, None if they are of no kind."""
    tokens = one_file(folder, "tokens.txt", "*tokens.txt")
    encoder, decoder = one_file(folder, "*encoder*.onnx"), one_file(folder, "*decoder*.onnx")
    joiner, whole = one_file(folder, "*joiner*.onnx"), one_file(folder, "model*.onnx")
    if tokens and encoder and decoder and joiner:
        return kinds.from_transducer(encoder, decoder, joiner, tokens, num_threads=_THREADS)
    if tokens and encoder and decoder:
        return kinds.from_whisper(encoder, decoder, tokens, num_threads=_THREADS)
    if tokens and whole:
        return kinds.from_nemo_ctc(whole, tokens, num_threads=_THREADS)
    return None
