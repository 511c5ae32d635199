"""Sound as numbers: loudness, resampling, and whether bytes are sound at all.

Sound is PCM: 16-bit little-endian samples, one channel.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

RATE_HZ = 16_000
"""Sample rate for speech."""
SAMPLE = 2
"""Bytes per sample."""
SILENCE_DBFS = -120.0
"""The level of silence, whose logarithm is not a number."""
LEVEL_S = 0.1
"""Length of the newest sound that a level covers."""
TEXT_READ = 8_000
"""Bytes that are examined for text."""
_FULL = 32768.0
_LETTERS_PER_S = 15.0
_VOICE_DBFS, _ROOM_DBFS = -24.0, -58.0


def samples_of(sound: bytes) -> NDArray[np.int16]:
    """Return the samples in PCM bytes, shape (n,); half a sample at the end is dropped."""
    return np.frombuffer(sound[: len(sound) // SAMPLE * SAMPLE], "<i2")


def level_dbfs(sound: bytes) -> float:
    """Return the loudness of PCM bytes: RMS relative to full scale, `SILENCE_DBFS` .. 0 dB.

    A full-scale sine has -3 dB.
    """
    samples = samples_of(sound).astype(np.float64)
    power = float(np.mean(np.square(samples / _FULL))) if len(samples) else 0.0
    return max(SILENCE_DBFS, 10.0 * math.log10(power)) if power > 0 else SILENCE_DBFS


class LevelMeter:
    """The level of the newest `LEVEL_S` of a stream."""

    def __init__(self, rate_hz: int) -> None:
        self._most = max(1, round(rate_hz * LEVEL_S)) * SAMPLE
        self._sound = b""

    def feed(self, sound: bytes) -> None:
        """Add the next PCM bytes, whole samples."""
        self._sound = (self._sound + sound)[-self._most :]

    @property
    def dbfs(self) -> float:
        """Return the loudness, `SILENCE_DBFS` before the first sound."""
        return level_dbfs(self._sound)


def mock_level_dbfs(words: str, since_s: float) -> float:
    """Return the level of a voice that began to speak this long ago, or of the quiet afterwards."""
    if since_s > len(words) / _LETTERS_PER_S:
        return _ROOM_DBFS
    # Syllables, one per quarter of a second.
    return _VOICE_DBFS + 8.0 * math.sin(8.0 * math.pi * since_s)


class Resampler:
    """Converts one sample rate to another by linear interpolation, a block at a time.

    The division into blocks does not affect the output. For a lower rate each sample is first
    averaged with its neighbours, against the worst aliasing.
    """

    def __init__(self, from_hz: int, to_hz: int) -> None:
        """Raise ValueError for invalid rates."""
        if from_hz <= 0 or to_hz <= 0:
            raise ValueError(f"a sample rate is above 0 Hz, not {min(from_hz, to_hz)}")
        self._from_hz, self._to_hz = from_hz, to_hz
        self._wide = max(1, round(from_hz / to_hz))
        self._tail = np.zeros(self._wide - 1)
        self._last = 0.0
        # In units of 1 / to_hz of an input sample: whole numbers, which do not drift.
        self._at = 0

    def feed(self, sound: bytes) -> bytes:
        """Resample the next PCM bytes, whole samples."""
        taken = samples_of(sound).astype(np.float64)
        if not len(taken):
            return b""
        smooth = self._smooth(taken)
        known = np.concatenate(([self._last], smooth))
        # `known` begins one sample before this block, at -1.
        end = (len(smooth) - 1) * self._to_hz
        places = np.arange(self._at, end + 1, self._from_hz)
        made = np.interp(places / self._to_hz, np.arange(-1, len(smooth)), known)
        self._at += len(places) * self._from_hz - len(smooth) * self._to_hz
        self._last = float(smooth[-1])
        return np.rint(made).astype("<i2").tobytes()

    def _smooth(self, taken: NDArray[np.float64]) -> NDArray[np.float64]:
        if self._wide == 1:
            return taken
        joined = np.concatenate((self._tail, taken))
        self._tail = joined[len(joined) - self._wide + 1 :]
        return np.convolve(joined, np.full(self._wide, 1 / self._wide), "valid")


def text_in(data: bytes) -> str | None:
    """Return the bytes as text, None if they are not: invalid UTF-8 or control characters.

    In the lessons text is sent in place of sound. Sound is hardly ever mistaken for text: the zeros
    of silence are control characters, and noise is invalid UTF-8.
    """
    cut = data[:TEXT_READ]
    try:
        text = cut.decode("utf-8")
    except UnicodeDecodeError as error:
        # A character cut in half at the end does not make the text invalid.
        if len(cut) == len(data) or error.start < len(cut) - 4:
            return None
        text = cut[: error.start].decode("utf-8")
    odd = sum(not (char.isprintable() or char.isspace()) for char in text)
    return None if odd * 10 > len(text) else text
