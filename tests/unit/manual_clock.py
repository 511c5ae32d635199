"""A clock that stands still until a test moves it."""

from __future__ import annotations

import asyncio
from typing import Any


class ManualClock:
    """Fits `launcher.processes.stop.Clock`."""

    def __init__(self) -> None:
        self._now = 1000.0
        self._sleepers: list[tuple[float, asyncio.Future[None]]] = []

    def now(self) -> float:
        return self._now

    async def wait(self, event: asyncio.Event, within_s: float) -> bool:
        alarm: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        sleeper = (self._now + within_s, alarm)
        self._sleepers.append(sleeper)
        coming = asyncio.ensure_future(event.wait())
        either: list[asyncio.Future[Any]] = [alarm, coming]
        try:
            await asyncio.wait(either, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._sleepers.remove(sleeper)
            coming.cancel()
        return event.is_set()

    async def advance(self, seconds: float) -> None:
        """Let so much time pass; whoever sleeps wakes at its own time."""
        await settle()
        end = self._now + seconds
        while True:
            due = min((at for at, alarm in self._sleepers if not alarm.done()), default=end + 1)
            if due > end:
                break
            self._now = max(due, self._now)
            for at, alarm in self._sleepers:
                if at <= self._now and not alarm.done():
                    alarm.set_result(None)
            await settle()
        self._now = end
        await settle()


async def settle() -> None:
    """Let every task run until it waits for something outside."""
    for _turn in range(30):
        await asyncio.sleep(0)
