"""How much is written to the terminal while pictures are shown: over SSH a key waits behind them.

Deck notices a slow line late: sshd and the network buffer a megabyte and more before a write
blocks. So there is a limit in bytes a second. All output counts, but only pictures wait for it;
text, and changes caused by a key, are sent at once.
"""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from typing import TYPE_CHECKING, Protocol

from tui.clock import steady

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from tui.terminal.pixels import Pixels

OVER_SSH = 40_000
"""Default limit in bytes a second if the terminal is connected through SSH."""
SAVED_S = 0.25
"""Unused bandwidth of this time may be used later at once, since pictures come unevenly."""
MOST_DEBT_S = 10.0
"""Whatever the limit and the output, another picture is shown after this time."""
AGAIN_S = 0.02
"""When to check again whether the terminal has taken its output."""
COUNTED = 8
"""Number of pictures from which the rate is computed."""
RECENT_S = 3.0


def default_limit(env: Mapping[str, str]) -> int:
    """Return the default limit in bytes a second, 0 for none."""
    return OVER_SSH if env.get("SSH_CONNECTION") else 0


class Bandwidth:
    """Counts what is written to one terminal, on any thread, and says when to send a picture."""

    def __init__(self, limit: int = 0, clock: Callable[[], float] = steady) -> None:
        """Allow `limit` bytes a second, or any number if it is 0."""
        self.limit = limit
        self.behind = False
        """Whether the terminal has yet to take some output; set by the writer."""
        self.is_slow = False
        """Whether the last picture had to wait for the terminal rather than for the limit."""
        self._clock = clock
        self._lock = threading.Lock()
        self._saved = limit * SAVED_S
        """Bytes that may be written at once; if negative, those written ahead of time."""
        self._seen_s = clock()

    def written(self, size: int) -> None:
        """Count this many bytes."""
        with self._lock:
            self._save()
            self._saved = max(self._saved - size, -MOST_DEBT_S * self.limit)

    def wait_s(self) -> float:
        """Return in how many seconds to ask again; 0.0 if a picture may be sent now."""
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

    async def free(self) -> None:
        """Return once a picture may be sent."""
        while wait_s := self.wait_s():  # noqa: ASYNC110 - it says when
            await asyncio.sleep(wait_s)

    def _save(self) -> None:
        now_s = self._clock()
        earned = (now_s - self._seen_s) * self.limit
        self._saved = min(self._saved + earned, self.limit * SAVED_S)
        self._seen_s = now_s


class HasBandwidth(Protocol):
    """An app that knows its terminal, and limits what is written to it."""

    bandwidth: Bandwidth
    pixels: Pixels


class PicturePace:
    """How often pictures of a stream are shown, and whether any were left out."""

    def __init__(self) -> None:
        """Start with no picture."""
        self._shown: deque[float] = deque(maxlen=COUNTED)
        self._left_out_s = float("-inf")

    def shown(self, now_s: float) -> None:
        if self._shown and now_s - self._shown[-1] > MOST_DEBT_S + RECENT_S:
            self._shown.clear()  # The stream had paused.
        self._shown.append(now_s)

    def left_out(self, now_s: float) -> None:
        """Record that a picture was replaced by a newer one before it was shown."""
        self._left_out_s = now_s

    def limited_hz(self, now_s: float) -> float | None:
        """Return how many are shown a second; None if no picture was left out recently."""
        if now_s - self._left_out_s > RECENT_S or len(self._shown) < 2:
            return None
        return (len(self._shown) - 1) / max(self._shown[-1] - self._shown[0], 1e-3)
