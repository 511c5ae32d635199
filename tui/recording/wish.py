"""What is to be recorded and for how long, as it was asked for."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, NamedTuple

from text.i18n import _

if TYPE_CHECKING:
    from pathlib import Path

    from graph.recording.recorder import RecordingStatus

SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0, "с": 1.0, "мин": 60.0, "ч": 3600.0}
BYTES = {"kb": 1e3, "mb": 1e6, "gb": 1e9, "кб": 1e3, "мб": 1e6, "гб": 1e9}
_LIMIT = re.compile(r"([0-9]{1,9}(?:[.,][0-9]{1,3})?)\s*([^\W\d_]*)\.?")


class RecordingLimit(NamedTuple):
    """When a recording ends by itself; infinite: never."""

    seconds: float = math.inf
    bytes: float = math.inf

    def is_reached(self, status: RecordingStatus) -> bool:
        """Return whether the recording has lasted so long, or is so large."""
        return status.seconds >= self.seconds or status.bytes >= self.bytes


class RecordingWish(NamedTuple):
    """A recording that somebody wants."""

    folder: Path
    """It does not exist yet."""
    left_out: frozenset[str] = frozenset()
    """Types of messages that are not recorded."""
    limit: RecordingLimit = RecordingLimit()


def read_limit(text: str) -> RecordingLimit:
    """Return the limit that somebody has typed: `10 min`, `90 s`, `1 h`, `500 MB`, `2 GB`.

    A number alone means minutes, an empty text no limit.

    Raises:
        ValueError: if it is none of these, with words for the user.
    """
    words = text.strip().casefold()
    if not words:
        return RecordingLimit()
    found = _LIMIT.fullmatch(words)
    number = 0.0 if found is None else float(found[1].replace(",", "."))
    unit = "" if found is None else found[2] or "min"
    if number <= 0 or unit not in SECONDS | BYTES:
        raise ValueError(_("expected a time or a size: 10 min, 90 s, 1 h, 500 MB, 2 GB"))
    if unit in SECONDS:
        return RecordingLimit(seconds=number * SECONDS[unit])
    return RecordingLimit(bytes=number * BYTES[unit])
