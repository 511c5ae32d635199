"""How far agents have driven without a question in the last minutes."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable

from launcher.consent import ALLOWED_FOR_S

_ROUNDING = 1e-9


class UnaskedWay:
    """Adds up the ways of the last `ALLOWED_FOR_S`, which is as long as an allowance lasts."""

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        self._now = now
        self._ways: deque[tuple[float, float]] = deque()

    def left_m(self, limit_m: float) -> float:
        """Return how far they may still go."""
        while self._ways and self._now() - self._ways[0][0] > ALLOWED_FOR_S:
            self._ways.popleft()
        return max(0.0, limit_m - sum(metres for _when, metres in self._ways))

    def has_room(self, metres: float, limit_m: float) -> bool:
        return metres <= self.left_m(limit_m) + _ROUNDING

    def add(self, metres: float) -> None:
        self._ways.append((self._now(), metres))
