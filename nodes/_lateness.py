"""Commands that have waited on their way, by their own stamps.

What a stopped publisher, or a link that hangs, has not delivered comes when that is over. The stamp
tells, as long as both sides go by one clock; a difference of more than `_ANOTHER_CLOCK_S` is one of
clocks and means nothing, and neither does a stamp of 0.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from nodes._speech import Phrase

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time

    from nodes._speech import Speech

_ANOTHER_CLOCK_S = 30.0
_LATE = Phrase(
    "A command was {age:.1f} s on its way and is not obeyed (or do the clocks of two computers"
    " differ?)",
    "Команда шла {age:.1f} с и не исполняется (или расходятся часы двух компьютеров?)",
)


def age_s(stamp: Time) -> float | None:
    """How long ago that was, s; None if the stamp does not tell."""
    if not (stamp.sec or stamp.nanosec):
        return None
    age = float(time.time() - stamp.sec - stamp.nanosec * 1e-9)
    return age if age < _ANOTHER_CLOCK_S else None


def is_late(say: Speech, stamp: Time, max_age_s: float) -> bool:
    """Whether a command is older than that, which is told; 0 seconds: any age will do."""
    age = age_s(stamp)
    late = bool(max_age_s) and age is not None and age > max_age_s
    if late:
        say.warn(_LATE, every_s=1.0, age=age)
    return late
