"""Who drives: several sources of commands, ranked, and how old a command may get.

A source counts while its newest command is younger than `max_age_s`; the first in rank that
counts drives, and the others are ignored. What an ignored source said is kept only for that
long too, so that a word of long ago never moves the robot when the one above it falls silent.

With a `max_age_s` of 0 no command grows old. Then a source holds the robot until it asks for a
stop, and what is said below it meanwhile, or was before, is forgotten.

A source that a person holds, by a key that has to stay down, grows old all the same: nobody may be
left to ask for the stop.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from robot.words import DriveSetpoint

HELD_AGE_S = 0.5
"""A held source says its word twenty times a second."""


@dataclass(frozen=True)
class SourceCommand:
    """The newest command of one source."""

    source: str
    setpoint: DriveSetpoint
    heard_s: float
    """By a monotonic clock."""

    def age_s(self, now_s: float) -> float:
        """Seconds since it was heard."""
        return max(0.0, now_s - self.heard_s)


class Sources:
    """The sources by rank, the highest first, and what each said last."""

    def __init__(self, ranked: Sequence[str], max_age_s: float, held: Collection[str] = ()) -> None:
        """Know these sources, and which of them are `held`; nobody has said anything."""
        self._ranked = tuple(ranked)
        self._held = frozenset(held)
        self._max_age_s = max_age_s
        self._orders: dict[str, SourceCommand] = {}
        self._newest = ""

    def let_age(self, max_age_s: float, now_s: float) -> None:
        """Let commands grow so old from now on; one that was too old already stays so."""
        if max_age_s != self._max_age_s:
            self._drop_old(now_s)
            self._max_age_s = max_age_s

    def hear(self, source: str, setpoint: DriveSetpoint, now_s: float) -> SourceCommand:
        """Take in a command; return the order that drives now, which may be one above it."""
        order = self._orders[source] = SourceCommand(source, setpoint, now_s)
        self._newest = source
        driving = self.driving(now_s) or order
        if self._max_age_s == 0:
            # Nothing grows old: what does not drive now must not do so later.
            self._orders = {driving.source: driving}
        return driving

    def driving(self, now_s: float) -> SourceCommand | None:
        """The order that drives; None if nobody's counts."""
        self._drop_old(now_s)
        return next((self._orders[name] for name in self._ranked if name in self._orders), None)

    def correct(self, order: SourceCommand, setpoint: DriveSetpoint) -> None:
        """Remember less than was asked for, for as long as the order itself would have counted."""
        if self._orders.get(order.source) is order:
            self._orders[order.source] = replace(order, setpoint=setpoint)

    def forget(self) -> None:
        """Wait for new commands of everybody."""
        self._orders.clear()

    def limit_s(self, source: str) -> float:
        """How old a command of this source may grow, 0 for any age."""
        if source not in self._held:
            return self._max_age_s
        return min(self._max_age_s or HELD_AGE_S, HELD_AGE_S)

    def _drop_old(self, now_s: float) -> None:
        self._orders = {
            name: order for name, order in self._orders.items() if self._counts(order, now_s)
        }

    def _counts(self, order: SourceCommand, now_s: float) -> bool:
        limit_s = self.limit_s(order.source)
        if limit_s == 0:
            return order.setpoint.speed_m_s != 0 or order.source == self._newest
        return order.age_s(now_s) < limit_s
