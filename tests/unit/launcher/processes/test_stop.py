"""Stopping all processes of a run: who is forked between two looks is stopped as well."""

from __future__ import annotations

import signal
from collections.abc import Sequence

from launcher.clock import MonotonicClock
from launcher.processes.stop import end_all
from launcher.processes.table import Process

PROCESS = Process(4711, "python", "S", 1, 4711, 4711, 0, 0)


class Forking:
    """Shows nobody at the first look, and one process from the second on, until it is told."""

    def __init__(self, ends_by: signal.Signals | None) -> None:
        self._ends_by = ends_by
        self._looks = 0
        self.heard: list[signal.Signals] = []

    def left(self) -> Sequence[Process]:
        self._looks += 1
        return [PROCESS] if self._looks > 1 and self._ends_by not in self.heard else []

    def signal(self, process: Process, number: signal.Signals) -> None:
        assert process == PROCESS
        self.heard.append(number)


async def test_who_comes_between_two_looks_is_stopped_and_not_told_as_left() -> None:
    target = Forking(signal.SIGINT)
    assert await end_all(target, MonotonicClock(), 30.0) == ()
    assert target.heard == [signal.SIGINT]


async def test_who_outlives_every_signal_is_told() -> None:
    assert await end_all(Forking(None), MonotonicClock(), 1.5) == [PROCESS]
