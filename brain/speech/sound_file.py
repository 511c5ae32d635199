"""Sound out of a file, whatever its rate and its channels."""

from __future__ import annotations

from pathlib import Path

from brain.speech.faults import SpeechError
from brain.speech.sound import Sound
from text.os_words import os_reason
from text.sentences import say

LONGEST_BYTES = 32 << 20


def read_sound(path: str, rate_hz: int) -> Sound:
    """Return what is in a WAV, FLAC, MP3 or Ogg Vorbis file, mixed down to one channel.

    Raises:
        SpeechError: it cannot be read, is too long, or is no sound; the words name the file.
    """
    import miniaudio

    try:
        file = Path(path).expanduser()
        if file.stat().st_size > LONGEST_BYTES:
            raise SpeechError(say("{path}: is too long", path=path))
        form = miniaudio.SampleFormat.SIGNED16
        decoded = miniaudio.decode(file.read_bytes(), form, 1, rate_hz)
    except OSError as error:
        words = say("{path}: cannot be read: {reason}", path=path, reason=os_reason(error))
        raise SpeechError(words) from None
    except miniaudio.DecodeError:
        raise SpeechError(say("{path}: is not a sound file", path=path)) from None
    return Sound(decoded.samples.tobytes(), rate_hz)
