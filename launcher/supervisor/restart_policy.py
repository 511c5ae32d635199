"""The decision whether and when a node that has ended is started again."""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

FIRST_DELAY_S = 1.0
LAST_DELAY_S = 30.0
STABLE_S = 20.0
"""For a node that ran this long, earlier crashes no longer count."""
MAX_CRASHES = 5
CRASH_WINDOW_S = 60.0


class Again(NamedTuple):
    """Start it again after a while."""

    delay_s: float


class GivenUp(NamedTuple):
    """It will not be started again."""

    crashes: int
    """How many times in a row it ended; 1 if the policy is not to start it again at all."""
    within_s: float = 0.0


class RestartPolicy:
    """The `restart:` policy of one node, with its history. Times are monotonic seconds."""

    def __init__(self, kind: str) -> None:
        """`kind`: `never`, `on-failure` or `always`."""
        self._kind = kind
        self._delay_s = FIRST_DELAY_S
        self._crashes: deque[float] = deque(maxlen=MAX_CRASHES)

    def reset(self) -> None:
        """Forget the history: the node was started by hand."""
        self._delay_s = FIRST_DELAY_S
        self._crashes.clear()

    def after(self, *, clean: bool, lasted_s: float, now: float) -> Again | GivenUp | None:
        """Decide after the node has ended by itself, `clean` if with exit code 0; None: it ended as intended."""
        if clean and self._kind != "always":
            return None
        if self._kind == "never":
            return GivenUp(1)
        if lasted_s >= STABLE_S:
            self.reset()
        self._crashes.append(now)
        within_s = now - self._crashes[0]
        if len(self._crashes) == MAX_CRASHES and within_s <= CRASH_WINDOW_S:
            return GivenUp(MAX_CRASHES, within_s)
        delay_s = self._delay_s
        self._delay_s = min(2 * delay_s, LAST_DELAY_S)
        return Again(delay_s)
