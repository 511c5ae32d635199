"""eSpeak NG: a voice for a hundred languages that needs no network and hardly any processor.

The library comes in the wheel `espeakng-loader`; it is called as espeak-ng/speak_lib.h says
(https://github.com/espeak-ng/espeak-ng/blob/master/src/include/espeak-ng/speak_lib.h).
"""

from __future__ import annotations

import ctypes
import threading
from functools import cache
from typing import Any

from brain.speech.faults import SpeechError, missing
from brain.speech.sound import Sound
from text.sentences import say

LONGEST_TEXT = 1000
"""Characters that are spoken; about a minute."""
LONGEST_S = 120.0
VOICES = {"en": "en-us", "ru": "ru"}
"""Language code to the name of its voice."""
_SYNCHRONOUS = 2
_DO_NOT_EXIT = 0x8000
_UTF8 = 1
_CHARACTERS = 1
_RATE, _PITCH = 1, 3
_CHUNK_MS = 100
_Callback = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p)

_lock = threading.Lock()
"""The library has one state for the whole process."""


class EspeakVoice:
    """Speaks; thread-safe.

    Raises:
        SpeechError: if the library is not installed or does not start.
    """

    def __init__(self, *, words_per_min: int = 160, pitch: int = 50) -> None:
        """`pitch` is 0 (low) to 99 (high)."""
        self._words_per_min, self._pitch = words_per_min, pitch
        with _lock:
            self._library, self._rate_hz = _load()

    def speak(self, text: str, language: str) -> Sound:
        """Return the spoken text, cut to `LONGEST_TEXT`; raises SpeechError.

        The text is plain: markup in it is read out, not obeyed. `language` is a key of `VOICES`, or
        the name of any voice of eSpeak's, with a variant after a + if wanted: en-gb+f2.
        """
        data = text[:LONGEST_TEXT].replace("\0", " ").encode("utf-8", "replace")
        name = VOICES.get(language, language)
        made = bytearray()
        most = int(LONGEST_S * self._rate_hz) * 2

        def take(samples: int | None, count: int, _events: int) -> int:
            if samples and count > 0:
                made.extend(ctypes.string_at(samples, 2 * count))
            return int(len(made) > most)

        callback = _Callback(take)
        with _lock:
            library = self._library
            if library.espeak_SetVoiceByName(name.encode("utf-8", "replace")) != 0:
                raise SpeechError(say("espeak-ng has no voice {name}", name=name))
            library.espeak_SetParameter(_RATE, self._words_per_min, 0)
            library.espeak_SetParameter(_PITCH, self._pitch, 0)
            library.espeak_SetSynthCallback(callback)
            problem = library.espeak_Synth(data, len(data) + 1, 0, _CHARACTERS, 0, _UTF8, None, None)
        if problem:
            raise SpeechError(say("espeak-ng does not speak: error {code}", code=problem))
        return Sound(bytes(made[:most]), self._rate_hz)


@cache
def _load() -> tuple[Any, int]:
    """Return the library and its sample rate; it is started once."""
    try:
        import espeakng_loader
    except ImportError:
        raise missing("espeakng-loader", "'deck-robot[voice]'") from None
    try:
        library: Any = ctypes.CDLL(espeakng_loader.get_library_path())
    except OSError as error:
        raise SpeechError(say("espeak-ng does not start: {reason}", reason=str(error))) from None
    library.espeak_Synth.argtypes = [
        *(ctypes.c_char_p, ctypes.c_size_t, ctypes.c_uint, ctypes.c_int, ctypes.c_uint),
        *(ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p),
    ]
    library.espeak_SetSynthCallback.argtypes = [_Callback]
    library.espeak_SetSynthCallback.restype = None
    data = espeakng_loader.get_data_path().encode()
    rate_hz = library.espeak_Initialize(_SYNCHRONOUS, _CHUNK_MS, data, _DO_NOT_EXIT)
    if rate_hz <= 0:
        reason = f"espeak_Initialize: {rate_hz}"
        raise SpeechError(say("espeak-ng does not start: {reason}", reason=reason))
    return library, rate_hz
