"""The supervisor's clock, replaceable so that a test need not wait out a backoff of 30 s."""

from __future__ import annotations

import asyncio
import time


class Clock:
    """The machine's monotonic clock, with a way to wait."""

    def now(self) -> float:
        return time.monotonic()

    async def wait(self, event: asyncio.Event, within_s: float) -> bool:
        """Wait for `event`, at most `within_s`; return whether it was set."""
        try:
            await asyncio.wait_for(event.wait(), within_s)
        except asyncio.TimeoutError:
            return False
        return True
