"""What a node refuses of what it is asked, why, and how it says so.

A command with a number beyond the limits, or with a stamp that does not belong to this moment, is
refused, and what is refused is a stop. That holds for the gate, the electronic differential and the
chassis alike; none of them trusts the one before it.
"""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, NamedTuple

from nodes.parts.parameters import Number
from nodes.parts.speech import Phrase
from robot.limits import PICO_RAD_S, first_excess

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
"""The parameter of who commands the wheels."""

_REMEMBER_S = 1.5
"""So long a state tells of it: a little longer than from one state to the next."""
_LONGEST_WAY_S = 2.0
"""For who lets commands grow as old as they like: that long one may have been on its way."""
_AHEAD_S = 0.5
_ANOTHER_CLOCK_S = 30.0
"""Nothing is so long on its way."""

_NO_NUMBER = Phrase(
    "{source} asks for {value:g} {unit}, which is no number: refused, stop",
    "{source} просит {value:g} {unit}, а это не число: отказ, стоп",
)
_BEYOND = Phrase(
    "{source} asks for {value:g} {unit}, the limit is {limit:g} {unit}: refused, stop",
    "{source} просит {value:g} {unit}, предел — {limit:g} {unit}: отказ, стоп",
)
_UNITS = {
    "m/s": Phrase("m/s", "м/с"),
    "rad": Phrase("rad", "рад"),
    "rad/s": Phrase("rad/s", "рад/с"),
}
_OLD = Phrase(
    "A command of {source} is {age:.1f} s old by its stamp and is not obeyed",
    "Команде {source} по её метке времени {age:.1f} с, она не исполняется",
)
_OTHER_CLOCK = Phrase(
    "The stamps of {source} are {age:.1f} s {which} this computer's clock: it is not obeyed;"
    " set the clocks of both computers (chrony, NTP), or leave the stamps at zero",
    "Метки времени {source} {which} часов этого компьютера на {age:.1f} с: команды не исполняются;"
    " сверьте часы обоих компьютеров (chrony, NTP) или оставьте метки нулевыми",
)
_BEHIND, _AHEAD = Phrase("behind", "отстают от"), Phrase("ahead of", "опережают показания")
_SHORT = Phrase(
    "{value:g} {unit}, limit {limit:g} {unit}", "{value:g} {unit} при пределе {limit:g} {unit}"
)
_SHORT_STAMP = Phrase("stamp {age:.1f} s old", "метке {age:.1f} с")


class Refusal(NamedTuple):
    """What was asked for and refused, in few words."""

    told: str
    """For programs, in English."""
    words: str
    """For people."""


class CommandRefusals:
    """What this node has refused lately."""

    def __init__(self, node: LessonNode) -> None:
        """Say it with the voice of `node`, and go by its clock."""
        self._node = node
        self._last: Refusal | None = None
        self._at_s = -math.inf

    @property
    def recent(self) -> Refusal | None:
        """What was refused in the last moments, None if nothing was."""
        return self._last if time.monotonic() - self._at_s < _REMEMBER_S else None

    def beyond(self, source: str, *asked: tuple[float, Limits]) -> bool:
        """Whether one of these numbers is none, or is beyond its limits; that is told."""
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
        """Whether it is stamped longer ago than that, or ahead; a stamp of zero tells nothing.

        With a `max_age_s` of 0 it may still not have been on its way for seconds.
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
