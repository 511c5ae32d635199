"""How much is written to the terminal while pictures go on: over SSH a key waits behind them.

Deck sees a slow line late: sshd and the network's own buffers take a megabyte and more before a
write waits. So there is a limit of bytes a second. All that is written counts, but only pictures
wait for it; text, and what a key changes, goes at once.
"""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING, Protocol

from tui.clock import steady

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

OVER_SSH = 40_000
"""Bytes a second by default where the terminal is at the other end of SSH."""
SAVED_S = 0.25
"""What was not written for so long may be written later at once: pictures come unevenly."""
MOST_DEBT_S = 10.0
"""However much is written, and however little may be: after so long there is another picture."""
AGAIN_S = 0.02
"""When to look again whether the terminal has taken what it was given."""
COUNTED = 8
"""Pictures of which the rate is made."""
RECENT_S = 3.0


def default_limit(env: Mapping[str, str]) -> int:
    """Return bytes a second, 0 for no limit, as fits where this program runs."""
    return OVER_SSH if env.get("SSH_CONNECTION") else 0


class Bandwidth:
    """Counts what is written to one terminal, on any thread, and says when a picture may go."""

    def __init__(self, limit: int = 0, clock: Callable[[], float] = steady) -> None:
        """Allow `limit` bytes a second, any number if it is 0."""
        self.limit = limit
        self.behind = False
        """Whether the terminal has not taken yet what it was given; the writer says so."""
        self.is_slow = False
        """Whether it was the terminal that the last picture had to wait for, not the limit."""
        self._clock = clock
        self._lock = threading.Lock()
        self._saved = limit * SAVED_S
        """Bytes that may be written at once; below 0 those that have been written too early."""
        self._seen_s = clock()

    def written(self, size: int) -> None:
        """Take note of so many bytes."""
        with self._lock:
            self._save()
            self._saved = max(self._saved - size, -MOST_DEBT_S * self.limit)

    def wait_s(self) -> float:
        """Return how many seconds from now to ask again; 0.0 if a picture may go now."""
        with self._lock:
            self._save()
            debt = -self._saved
        if debt > 0:
            self.is_slow = False
            return max(debt / self.limit, AGAIN_S)
        if self.behind:
            self.is_slow = True
            return AGAIN_S
        return 0.0

    def _save(self) -> None:
        now_s = self._clock()
        earned = (now_s - self._seen_s) * self.limit
        self._saved = min(self._saved + earned, self.limit * SAVED_S)
        self._seen_s = now_s


class HasBandwidth(Protocol):
    """An app that knows how much may be written to its terminal."""

    bandwidth: Bandwidth


class PicturePace:
    """How often one picture of a stream is shown, and whether others were left out for it."""

    def __init__(self) -> None:
        """Begin with no picture."""
        self._shown: deque[float] = deque(maxlen=COUNTED)
        self._left_out_s = float("-inf")

    def shown(self, now_s: float) -> None:
        """Take note of a picture that is shown."""
        if self._shown and now_s - self._shown[-1] > MOST_DEBT_S + RECENT_S:
            self._shown.clear()  # The stream had paused.
        self._shown.append(now_s)

    def left_out(self, now_s: float) -> None:
        """Take note of a picture that a newer one has replaced before it was shown."""
        self._left_out_s = now_s

    def limited_hz(self, now_s: float) -> float | None:
        """Return how many are shown a second; None if no picture was left out lately."""
        if now_s - self._left_out_s > RECENT_S or len(self._shown) < 2:
            return None
        return (len(self._shown) - 1) / max(self._shown[-1] - self._shown[0], 1e-3)
