"""Which commands a node refuses, why, and how it reports that.

A command with a number beyond the limits, or with a stamp from another time, is refused, and a
refused command counts as a stop. That holds for the gate, the electronic differential and the
chassis alike; none of them trusts the previous one.
"""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, NamedTuple

from nodes.parts.parameters import Number
from robot.limits import PICO_RAD_S, first_excess
from text.i18n import N_

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time

    from nodes.parts.node import LessonNode
    from robot.limits import Limits

MAX_WHEEL_SPEED = Number(
    "max_wheel_speed",
    PICO_RAD_S,
    "As the Pico has it; both wheels are slowed to it",
    low=0.1,
    high=200.0,
    unit="rad/s",
)
"""The parameter of nodes that command the wheels."""

_REMEMBER_S = 1.5
"""How long the state reports a refusal: a little longer than its period."""
_LONGEST_WAY_S = 2.0
"""The maximum transport delay of a command, for nodes without an age limit."""
_AHEAD_S = 0.5
_ANOTHER_CLOCK_S = 30.0
"""No message takes this long to arrive."""

_NO_NUMBER = N_("{source} asks for {value:g} {unit}, which is not a number: refused, stop")
_BEYOND = N_("{source} asks for {value:g} {unit}, the limit is {limit:g} {unit}: refused, stop")
_UNITS = {"m/s": N_("m/s"), "rad": N_("rad"), "rad/s": N_("rad/s")}
_OLD = N_("A command of {source} is {age:.1f} s old by its stamp and is not obeyed")
_OTHER_CLOCK = N_(
    "The stamps of {source} are {age:.1f} s {which} this computer's clock: it is not obeyed;"
    " set the clocks of both computers (chrony, NTP), or leave the stamps at zero"
)
_BEHIND, _AHEAD = N_("behind"), N_("ahead of")
_SHORT = N_("{value:g} {unit}, limit {limit:g} {unit}")
_SHORT_STAMP = N_("stamp {age:.1f} s old")


class Refusal(NamedTuple):
    """A refused command, in a few words."""

    told: str
    """For programs, in English."""
    words: str
    """For people."""


class CommandRefusals:
    """The recent refusals of this node."""

    def __init__(self, node: LessonNode) -> None:
        """Log through `node`, and use its clock."""
        self._node = node
        self._last: Refusal | None = None
        self._at_s = -math.inf

    @property
    def recent(self) -> Refusal | None:
        """Return the last recent refusal, None if there is none."""
        return self._last if time.monotonic() - self._at_s < _REMEMBER_S else None

    def beyond(self, source: str, *asked: tuple[float, Limits]) -> bool:
        """Whether one of these values is not a number or beyond its limits; that is logged."""
        excess = first_excess(*asked)
        if excess is None:
            return False
        say = self._node.say
        value, limit = excess.value, excess.limits.high
        unit = say.text(_UNITS[excess.limits.unit])
        self._remember(str(excess), say.text(_SHORT, value=value, unit=unit, limit=limit))
        phrase = _BEYOND if math.isfinite(value) else _NO_NUMBER
        say.error(phrase, every_s=1.0, source=source, value=value, unit=unit, limit=limit)
        return True

    def untimely(self, source: str, stamp: Time, max_age_s: float) -> bool:
        """Whether its stamp is older than that, or in the future; a stamp of zero is ignored.

        Even with a `max_age_s` of 0 it must not have been under way for seconds.
        """
        if not (stamp.sec or stamp.nanosec):
            return False
        now_s = self._node.get_clock().now().nanoseconds * 1e-9
        age_s = now_s - stamp.sec - stamp.nanosec * 1e-9
        if -_AHEAD_S <= age_s <= (max_age_s or _LONGEST_WAY_S):
            return False
        say = self._node.say
        self._remember(f"stamp {age_s:.1f} s old", say.text(_SHORT_STAMP, age=age_s))
        if 0 < age_s < _ANOTHER_CLOCK_S:
            say.warn(_OLD, every_s=1.0, source=source, age=age_s)
        else:
            which = say.text(_BEHIND if age_s > 0 else _AHEAD)
            say.error(_OTHER_CLOCK, every_s=1.0, source=source, age=abs(age_s), which=which)
        return True

    def _remember(self, told: str, words: str) -> None:
        self._last, self._at_s = Refusal(told, words), time.monotonic()
