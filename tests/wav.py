"""Sound as the bytes of a WAV file."""

from __future__ import annotations

import io
import wave
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from brain.speech.sound import Sound


def wav_of(sound: Sound) -> bytes:
    file = io.BytesIO()
    with wave.open(file, "wb") as to:
        to.setnchannels(1)
        to.setsampwidth(2)
        to.setframerate(sound.rate_hz)
        to.writeframes(sound.pcm)
    return file.getvalue()
