"""From a stream of sound to whole utterances: where somebody begins and ceases to speak.

The voice activity detector is WebRTC's, inside pocketsphinx: it says of each frame whether there is
voice in it. pocketsphinx has an endpointer too, but that wants as much voice to begin as it wants
silence to end, and so misses words as short as "stop".
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from brain.speech.faults import missing
from brain.speech.sound import Sound

if TYPE_CHECKING:
    import pocketsphinx

CLOSING_S = 0.3
"""Silence that ends an utterance. It is a part of the time until the robot reacts."""
LONGEST_S = 15.0
"""An utterance that goes on for longer is cut here; what follows is another."""
FRAME_S = 0.03
_BEFORE_S = 0.3
"""Sound before the first voice that belongs to it: quiet consonants are no voice."""
_OPENING, _OPENING_VOICED = 6, 4
"""So many of the last frames must be voice to begin: more than a click or a cough has."""
_CLOSING_VOICED = 1
"""So many of the frames of the closing silence may be voice: noise is now and then taken for it."""


class Utterances:
    """Cuts a stream; raises SpeechError if pocketsphinx is not installed."""

    def __init__(self, rate_hz: int, *, closing_s: float = CLOSING_S, longest_s: float = LONGEST_S) -> None:
        """`rate_hz` is 8000, 16000, 32000 or 48000, or near one of these."""
        self._vad = _detector(rate_hz)
        self.rate_hz = rate_hz
        self._longest = int(longest_s * rate_hz) * 2
        self._recent: deque[bool] = deque(maxlen=max(2, round(closing_s / FRAME_S)))
        self._before: deque[bytes] = deque(maxlen=round(_BEFORE_S / FRAME_S))
        self._rest = b""
        self._speech = bytearray()

    @property
    def speaking(self) -> bool:
        """Whether somebody is speaking right now."""
        return bool(self._speech)

    def feed(self, pcm: bytes) -> list[Sound]:
        """Take the next piece of sound, of any length; return the utterances that ended in it."""
        ended: list[Sound] = []
        self._rest += pcm
        size = self._vad.frame_bytes
        while len(self._rest) >= size:
            frame, self._rest = self._rest[:size], self._rest[size:]
            if self._take(frame):
                ended.append(Sound(bytes(self._speech), self.rate_hz))
                self._speech.clear()
        return ended

    def reset(self) -> None:
        """Forget the sound so far, as after the robot's own words."""
        self._rest = b""
        for kept in (self._recent, self._before, self._speech):
            kept.clear()

    def _take(self, frame: bytes) -> bool:
        """Take a frame; return whether an utterance ends with it."""
        self._recent.append(self._vad.is_speech(frame))
        if self._speech:
            self._speech += frame
            silent = len(self._recent) == self._recent.maxlen
            silent = silent and sum(self._recent) <= _CLOSING_VOICED and not self._recent[-1]
            return silent or len(self._speech) >= self._longest
        self._before.append(frame)
        if sum(list(self._recent)[-_OPENING:]) >= _OPENING_VOICED:
            self._speech += b"".join(self._before)
            self._before.clear()
        return False


def _detector(rate_hz: int) -> pocketsphinx.Vad:
    try:
        import pocketsphinx
    except ImportError:
        raise missing("pocketsphinx", "'deck-robot[voice]'") from None
    return pocketsphinx.Vad(pocketsphinx.Vad.STRICT, rate_hz, FRAME_S)
