"""Sound as numbers: how loud it is, another sample rate, and whether bytes are sound at all.

Sound is PCM: 16-bit little-endian samples, one channel.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

RATE_HZ = 16_000
"""What speech is taken at."""
SAMPLE = 2
"""Bytes of a sample."""
SILENCE_DBFS = -120.0
"""Told where nothing sounds, for the logarithm of nothing is no number."""
LEVEL_S = 0.1
"""How much of the newest sound a level is of."""
TEXT_READ = 8_000
"""Bytes that are looked at for a text."""
_FULL = 32768.0
_LETTERS_PER_S = 15.0
_VOICE_DBFS, _ROOM_DBFS = -24.0, -58.0


def samples_of(sound: bytes) -> NDArray[np.int16]:
    """The samples in PCM bytes, shape (n,); half a sample at the end is left out."""
    return np.frombuffer(sound[: len(sound) // SAMPLE * SAMPLE], "<i2")


def level_dbfs(sound: bytes) -> float:
    """Loudness of PCM bytes: root mean square against full scale, `SILENCE_DBFS` .. 0 dB.

    A sine of full scale has -3 dB.
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
        """Take the next PCM bytes, whole samples."""
        self._sound = (self._sound + sound)[-self._most :]

    def clear(self) -> None:
        """The stream has ended."""
        self._sound = b""

    @property
    def dbfs(self) -> float:
        """Loudness, `SILENCE_DBFS` before the first sound."""
        return level_dbfs(self._sound)


def mock_level_dbfs(words: str, since_s: float) -> float:
    """The level of a voice that began to say words so long ago, and of the quiet room after it."""
    if since_s > len(words) / _LETTERS_PER_S:
        return _ROOM_DBFS
    # Syllables, one in a quarter of a second.
    return _VOICE_DBFS + 8.0 * math.sin(8.0 * math.pi * since_s)


class Resampler:
    """From one sample rate to another, straight lines between samples, a block at a time.

    Cutting a stream into other blocks changes nothing of what comes out. On the way down each
    sample is first averaged with its neighbours, against the worst of the false tones.
    """

    def __init__(self, from_hz: int, to_hz: int) -> None:
        """Raise ValueError for rates that are none."""
        if from_hz <= 0 or to_hz <= 0:
            raise ValueError(f"a sample rate is above 0 Hz, not {min(from_hz, to_hz)}")
        self._from_hz, self._to_hz = from_hz, to_hz
        self._wide = max(1, round(from_hz / to_hz))
        self._tail = np.zeros(self._wide - 1)
        self._last = 0.0
        # In units of 1 / to_hz of an input sample: whole numbers, so that nothing drifts.
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
    """The text that bytes are, None if they are none: broken UTF-8 or control characters.

    In the lessons words go where sound will go. Sound is hardly ever taken for text: the zeros of
    silence are control characters, and noise is broken UTF-8.
    """
    cut = data[:TEXT_READ]
    try:
        text = cut.decode("utf-8")
    except UnicodeDecodeError as error:
        # A letter that the cut went through is no fault of the text.
        if len(cut) == len(data) or error.start < len(cut) - 4:
            return None
        text = cut[: error.start].decode("utf-8")
    odd = sum(not (char.isprintable() or char.isspace()) for char in text)
    return None if odd * 10 > len(text) else text
