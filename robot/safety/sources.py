"""Who drives: several ranked sources of commands, and how long a command stays valid.

A source is active while its newest command is younger than `max_age_s`; the highest-ranked active
source drives, and the others are ignored. A command of an ignored source is kept no longer than
that either, so that an old command never moves the robot when a higher source falls silent.

With a `max_age_s` of 0 commands do not expire. Then a source keeps the robot until it asks for a
stop, and commands of lower sources, earlier or meanwhile, are forgotten.

A source that a person holds, with a key that must stay down, still expires: there may be nobody
left to ask for the stop.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

from robot.words import DriveSetpoint

HELD_AGE_S = 0.5
"""A held source sends twenty commands a second."""


@dataclass(frozen=True)
class SourceCommand:
    """The newest command of one source."""

    source: str
    setpoint: DriveSetpoint
    heard_s: float
    """On a monotonic clock."""

    def age_s(self, now_s: float) -> float:
        """Return the seconds since it was received."""
        return max(0.0, now_s - self.heard_s)


class Sources:
    """The sources by rank, highest first, and the last command of each."""

    def __init__(self, ranked: Sequence[str], max_age_s: float, held: Collection[str] = ()) -> None:
        """Start with these sources, some of them `held`, and no commands."""
        self._ranked = tuple(ranked)
        self._held = frozenset(held)
        self._max_age_s = max_age_s
        self._orders: dict[str, SourceCommand] = {}
        self._newest = ""

    def let_age(self, max_age_s: float, now_s: float) -> None:
        """Change the age limit of commands; those already expired stay so."""
        if max_age_s != self._max_age_s:
            self._drop_old(now_s)
            self._max_age_s = max_age_s

    def hear(self, source: str, setpoint: DriveSetpoint, now_s: float) -> SourceCommand:
        """Add a command; return the one that drives now, which may be of a higher source."""
        order = self._orders[source] = SourceCommand(source, setpoint, now_s)
        self._newest = source
        driving = self.driving(now_s) or order
        if self._max_age_s == 0:
            # Commands do not expire: one that does not drive now must not do so later.
            self._orders = {driving.source: driving}
        return driving

    def driving(self, now_s: float) -> SourceCommand | None:
        """Return the command that drives; None if no source is active."""
        self._drop_old(now_s)
        return next((self._orders[name] for name in self._ranked if name in self._orders), None)

    def correct(self, order: SourceCommand, setpoint: DriveSetpoint) -> None:
        """Replace a command by a reduced one that expires when the command itself would have."""
        if self._orders.get(order.source) is order:
            self._orders[order.source] = replace(order, setpoint=setpoint)

    def forget(self) -> None:
        """Forget all commands and wait for new ones."""
        self._orders.clear()

    def limit_s(self, source: str) -> float:
        """Return how old a command of this source may get, 0 for any age."""
        if source not in self._held:
            return self._max_age_s
        return min(self._max_age_s or HELD_AGE_S, HELD_AGE_S)

    def _drop_old(self, now_s: float) -> None:
        self._orders = {name: order for name, order in self._orders.items() if self._counts(order, now_s)}

    def _counts(self, order: SourceCommand, now_s: float) -> bool:
        limit_s = self.limit_s(order.source)
        if limit_s == 0:
            return order.setpoint.speed_m_s != 0 or order.source == self._newest
        return order.age_s(now_s) < limit_s
