"""Stopping a node in stages (SIGINT, SIGTERM, SIGKILL), until none of its processes is left."""

from __future__ import annotations

import asyncio
import signal
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from launcher.processes.signal import KILLED_AFTER_S, send
from launcher.processes.table import Process


class Clock:
    """The machine's monotonic clock, with a way to wait; a test that need not wait has another."""

    def now(self) -> float:
        return time.monotonic()

    async def wait(self, event: asyncio.Event, within_s: float) -> bool:
        """Wait for `event`, at most `within_s`; return whether it was set."""
        try:
            await asyncio.wait_for(event.wait(), within_s)
        except asyncio.TimeoutError:
            return False
        return True


@dataclass(frozen=True)
class StopTimeouts:
    """How long each stage may take."""

    interrupt_s: float
    """From SIGINT to SIGTERM."""
    terminate_s: float
    """From SIGTERM to SIGKILL."""

    def stage(self, elapsed_s: float) -> int:
        """Return the stage at this time after the beginning: 0, 1 or 2."""
        return (elapsed_s >= self.interrupt_s) + (elapsed_s >= self.interrupt_s + self.terminate_s)


PATIENT = StopTimeouts(5.0, 5.0)
QUICK = StopTimeouts(KILLED_AFTER_S, 0.4)
"""For a repeated request, and for a robot whose owner is gone: done well within 2 s."""

STAGES = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
_LOOK_EVERY_S = 0.1
_SPEAK_AFTER_S = 0.5
_KILLED_LOOKS = 50
"""So many looks after SIGKILL, 5 s, a process does not end by it: it is stuck in the kernel.

Looks and not seconds, which also pass while this process itself is starved.
"""


class StagedStop:
    """One stop in progress."""

    def __init__(
        self,
        left: Callable[[], Sequence[Process]],
        clock: Clock,
        on_holdup: Callable[[Sequence[Process], signal.Signals], None],
        pace: StopTimeouts = PATIENT,
        on_stuck: Callable[[Sequence[Process]], None] = lambda _left: None,
    ) -> None:
        """`left` returns the processes that are alive.

        `on_holdup` is called with what is left and the last signal, whenever these change.

        `on_stuck` is called once, with what has not ended 5 s after SIGKILL.
        """
        self._on_stuck = on_stuck
        self._left = left
        self._clock = clock
        self._on_holdup = on_holdup
        self._pace = pace
        self._wake = asyncio.Event()

    def hurry(self) -> None:
        """Skip the waits: the stop was requested twice, or there is no time."""
        self._pace = QUICK
        self._wake.set()

    def look(self) -> None:
        """Check at once: a process has ended."""
        self._wake.set()

    async def run(self) -> None:
        """Return when nothing is left."""
        began = self._clock.now()
        told: dict[int, int] = {}
        shown: object = None
        killed_looks = 0
        while True:
            left = self._left()
            if not left:
                return
            elapsed = self._clock.now() - began
            stage = self._pace.stage(elapsed)
            for process in left:
                if told.get(process.pid, -1) < stage or STAGES[stage] == signal.SIGKILL:
                    told[process.pid] = stage
                    # Woken if it is suspended, so that it handles it.
                    send(process, STAGES[stage], signal.SIGCONT)
            view = (tuple(process.pid for process in left), stage)
            if elapsed >= _SPEAK_AFTER_S and view != shown:
                shown = view
                self._on_holdup(left, STAGES[stage])
            killed_looks += STAGES[stage] == signal.SIGKILL
            if killed_looks == _KILLED_LOOKS:
                self._on_stuck(left)
            await self._clock.wait(self._wake, _LOOK_EVERY_S)
            self._wake.clear()


async def end_all(
    find: Callable[[], Sequence[Process]], clock: Clock, within_s: float, pace: StopTimeouts = QUICK
) -> Sequence[Process]:
    """Stop all processes in a hurry, new ones too; return those that outlive `within_s`.

    A scan may miss a process that is just being forked, so the last two must find none.
    """

    async def end() -> None:
        while True:
            await StagedStop(find, clock, _say_nothing, pace).run()
            if not find():
                return

    ending = asyncio.create_task(end())
    await asyncio.wait([ending], timeout=within_s)
    if ending.done():
        ending.result()
        return ()
    ending.cancel()
    return find()


def _say_nothing(left: Sequence[Process], number: signal.Signals) -> None:
    """Ignore it: at the end of the run, what is left is reported separately."""
