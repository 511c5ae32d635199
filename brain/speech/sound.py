"""PCM with its sample rate, from one rate to another, and out of a file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from brain.speech.faults import SpeechError
from text.os_words import os_reason
from text.sentences import say

LONGEST_BYTES = 32 << 20
"""Of a file."""


@dataclass(frozen=True)
class Sound:
    """A piece of sound."""

    pcm: bytes
    """16-bit little-endian samples, one channel."""
    rate_hz: int

    @property
    def seconds(self) -> float:
        return len(self.pcm) / 2 / self.rate_hz

    def at(self, rate_hz: int) -> Sound:
        """Return the same sound at another rate, low-pass filtered on the way down."""
        if rate_hz == self.rate_hz or not self.pcm:
            return Sound(self.pcm, rate_hz)
        import miniaudio

        form = miniaudio.SampleFormat.SIGNED16
        made = miniaudio.convert_frames(form, 1, self.rate_hz, self.pcm, form, 1, rate_hz)
        return Sound(bytes(made), rate_hz)


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
