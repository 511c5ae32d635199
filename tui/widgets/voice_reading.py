"""What a message of sound says: text, as in the lessons, or PCM samples, or neither."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tui.i18n import _, ngettext
from tui.widgets.plain import plain

SAMPLE_RATE_HZ = 16_000
LONGEST_TEXT = 2_000
SHOWN_BYTES = 12
LEAST_PCM = 64
"""Bytes; fewer are no sound that anybody could hear."""
SLICES = 8
QUIETEST_DB = -60.0
LEVELS = "▁▂▃▄▅▆▇█"


@dataclass(frozen=True)
class Heard:
    """One message: its text, or how long it sounds and how loud."""

    text: str = ""
    seconds: float = 0.0
    levels: str = ""

    @property
    def is_sound(self) -> bool:
        """Whether it is samples."""
        return bool(self.levels)

    @property
    def words(self) -> str:
        """What is shown."""
        if not self.is_sound:
            return self.text
        return _("PCM 16-bit, {seconds} s, level {levels}").format(
            seconds=f"{self.seconds:.1f}", levels=self.levels
        )

    def and_then(self, later: Heard) -> Heard:
        """Two pieces of one sound."""
        levels = (self.levels + later.levels)[-SLICES:]
        return Heard("", self.seconds + later.seconds, levels)


def heard(data: bytes, sample_rate_hz: int = SAMPLE_RATE_HZ) -> Heard:
    """Read the bytes of a message; whatever they are, the result can be shown."""
    if not data:
        return Heard(_("(an empty message)"))
    text = _text_in(data)
    if text is not None:
        return Heard(text)
    if len(data) < LEAST_PCM:
        count = ngettext("{count} byte, no text:", "{count} bytes, no text:", len(data))
        more = "…" if len(data) > SHOWN_BYTES else ""
        return Heard(f"{count.format(count=len(data))} {data[:SHOWN_BYTES].hex(' ')}{more}")
    samples = np.frombuffer(data[: len(data) // 2 * 2], "<i2")
    return Heard("", len(samples) / sample_rate_hz, _levels(samples.astype(np.float64)))


def _text_in(data: bytes) -> str | None:
    """The text that the bytes are, None if they are none: broken UTF-8 or control characters."""
    cut = data[: 4 * LONGEST_TEXT]
    try:
        text = cut.decode("utf-8")
    except UnicodeDecodeError as error:
        if len(cut) == len(data) or error.start < len(cut) - 4:
            return None
        text = cut[: error.start].decode("utf-8")
    odd = sum(not (char.isprintable() or char.isspace()) for char in text)
    if odd * 10 > len(text):
        return None
    return plain(" ".join(text.split()), LONGEST_TEXT)


def _levels(samples: np.ndarray[tuple[int], np.dtype[np.float64]]) -> str:
    """Loudness of each slice of the sound as a column."""
    levels = ""
    for part in np.array_split(samples, SLICES):
        power = float(np.mean(np.square(part / 32768.0))) if len(part) else 0.0
        decibels = 10 * np.log10(power) if power > 0 else QUIETEST_DB
        share = 1 - max(QUIETEST_DB, min(0.0, float(decibels))) / QUIETEST_DB
        levels += LEVELS[min(len(LEVELS) - 1, int(share * len(LEVELS)))]
    return levels
