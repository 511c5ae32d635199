"""The content of a sound message: text, as in the lessons, or PCM samples, or neither."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from robot.sound import RATE_HZ, level_dbfs, samples_of, text_in
from text.i18n import _, decimal, ngettext
from text.plain import plain

if TYPE_CHECKING:
    from numpy.typing import NDArray

LONGEST_TEXT = 2_000
SHOWN_BYTES = 12
LEAST_PCM = 64
"""In bytes; anything shorter is not audible."""
SLICES = 8
QUIETEST_DB = -60.0
LEVELS = "▁▂▃▄▅▆▇█"


@dataclass(frozen=True)
class Heard:
    """One message: its text, or the duration and loudness of its sound."""

    text: str = ""
    seconds: float = 0.0
    levels: str = ""

    @property
    def is_sound(self) -> bool:
        return bool(self.levels)

    @property
    def words(self) -> str:
        if not self.is_sound:
            return self.text
        return _("PCM {seconds} s {levels}").format(seconds=decimal(f"{self.seconds:.1f}"), levels=self.levels)

    def and_then(self, later: Heard) -> Heard:
        """Join two pieces of one sound."""
        levels = (self.levels + later.levels)[-SLICES:]
        return Heard("", self.seconds + later.seconds, levels)


def heard(data: bytes, sample_rate_hz: int = RATE_HZ) -> Heard:
    """Read the bytes of a message; any input gives a result that can be shown."""
    if not data:
        return Heard(_("(an empty message)"))
    text = _text_in(data)
    if text is not None:
        return Heard(text)
    if len(data) < LEAST_PCM:
        count = ngettext("{count} byte, not text:", "{count} bytes, not text:", len(data))
        more = "…" if len(data) > SHOWN_BYTES else ""
        return Heard(f"{count.format(count=len(data))} {data[:SHOWN_BYTES].hex(' ')}{more}")
    samples = samples_of(data)
    return Heard("", len(samples) / sample_rate_hz, _levels(samples))


def _text_in(data: bytes) -> str | None:
    text = text_in(data)
    return None if text is None else plain(" ".join(text.split()), LONGEST_TEXT)


def _levels(samples: NDArray[np.int16]) -> str:
    """The loudness of each slice of the sound as a column."""
    levels = ""
    for part in np.array_split(samples, SLICES):
        share = 1 - max(QUIETEST_DB, level_dbfs(part.tobytes())) / QUIETEST_DB
        levels += LEVELS[min(len(LEVELS) - 1, int(share * len(LEVELS)))]
    return levels
