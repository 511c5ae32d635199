"""Whether what the observer sees may be old although it lives, so that a fresh look is due.

There is reason for doubt while a process of this machine is in the domain and none of its nodes is
seen, and, where other machines may be, while one that was seen is gone, or nobody has been seen.
Often there is nothing behind it: a program without a node, a robot that was switched off. So a
second observer looks, and takes over only if it sees all that the first sees, and more. If not, the
same reason counts less and less.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from graph.observer.census import Census

LASTS_S = 6.0
"""A node is seen within this, on a busy machine as well."""
FIRST_AGAIN_S, LAST_AGAIN_S = 5.0, 30.0
"""After a look that has found nothing, the next one comes after this, and each time twice that."""
LONG_S, SELDOM_S = 900.0, 300.0
"""Who has been gone for so long is looked for so seldom."""
LOOKS_FOR_S = 12.0
"""How long a second observer looks before it is sent away."""
SURE_S = 1.5
"""How long it must have seen more: the first may just be about to see it as well."""


class Doubt:
    """Of one observer; times are on the monotonic clock."""

    def __init__(self, now_s: float) -> None:
        self._missing: dict[int, float] = {}
        """Processes that are not seen, and since when."""
        self._explained: frozenset[int] = frozenset()
        """Those that a second observer did not see either."""
        self._gone: dict[bytes, float] = {}
        """Participants on a network that were seen once, and since when they are not."""
        self._known: frozenset[bytes] = frozenset()
        self._alone_since_s: float | None = now_s
        self._again_s = FIRST_AGAIN_S
        self._next_s = now_s

    def see(self, found: Census, now_s: float) -> None:
        self._missing = {pid: self._missing.get(pid, now_s) for pid in found.missing}
        self._explained &= found.missing
        if not found.is_networked:
            return
        for one in self._known - found.known:
            self._gone[one] = now_s
        if found.known - self._known:
            # It finds others: what is gone has left, or will come back by itself.
            self._gone.clear()
            self._again_s = FIRST_AGAIN_S
        self._known = found.known
        if found.known:
            self._alone_since_s = None
        elif self._alone_since_s is None:
            self._alone_since_s = now_s

    def is_due(self, now_s: float, is_networked: bool) -> bool:
        """Return whether a second observer should look."""
        if now_s < self._next_s:
            return False
        fresh = self._missing.keys() - self._explained
        if any(now_s - self._missing[pid] >= LASTS_S for pid in fresh):
            return True
        since_s = self._since_s() if is_networked else math.inf
        return now_s - since_s >= LASTS_S

    def nothing_found(self, now_s: float) -> None:
        """The second observer has seen no more: wait before there is another look."""
        self._explained = frozenset(self._missing)
        since_s = self._since_s()
        long_ago = now_s - since_s > LONG_S
        self._next_s = now_s + (SELDOM_S if long_ago else self._again_s)
        self._again_s = min(2.0 * self._again_s, LAST_AGAIN_S)

    def _since_s(self) -> float:
        """Return since when somebody on the network has been gone, or nobody there."""
        alone_s = math.inf if self._alone_since_s is None else self._alone_since_s
        return min(alone_s, min(self._gone.values(), default=math.inf))


class SecondLook:
    """What a second observer sees, compared with the first."""

    def __init__(self, now_s: float) -> None:
        self._until_s = now_s + LOOKS_FOR_S
        self._more_since_s: float | None = None

    def sees_more(self, first: Census, second: Census, now_s: float) -> bool:
        """Return whether it surely sees more than the first, and all of that."""
        if not second.known > first.known:
            self._more_since_s = None
            return False
        if self._more_since_s is None:
            self._more_since_s = now_s
        return now_s - self._more_since_s >= SURE_S

    def is_over(self, now_s: float) -> bool:
        return now_s >= self._until_s
