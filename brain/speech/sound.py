"""PCM with its sample rate, and the way from one rate to another."""

from __future__ import annotations

from dataclasses import dataclass


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
