"""What the nodes cost: processor time and memory of all their processes together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from launcher.processes.table import TICKS_PER_S

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from launcher.processes.table import Process


@dataclass(frozen=True)
class Usage:
    """What one node costs."""

    cpu_percent: float | None
    """Percent of one core since the measurement before; None at the first."""
    memory_bytes: int | None
    """Proportional set size; None where the kernel does not tell."""


class UsageMeter:
    """Measures repeatedly; remembers the last measurement."""

    _MEMORY_EVERY = 3
    """Measurements between two of memory, for which the kernel walks all pages of a process."""

    def __init__(self) -> None:
        self._cpu: dict[tuple[int, int], int] = {}
        self._memory: dict[str, tuple[frozenset[int], int | None]] = {}
        self._measured_at: float | None = None
        self._turn = 0

    def measure(self, members: Mapping[str, Sequence[Process]], now: float) -> dict[str, Usage]:
        """Measure every node; `now` in monotonic seconds."""
        elapsed = None if self._measured_at is None else now - self._measured_at
        before, self._measured_at = self._cpu, now
        self._cpu = {}
        self._turn += 1
        usages = {}
        for position, (name, processes) in enumerate(members.items()):
            ticks = 0
            for process in processes:
                key = (process.pid, process.started_ticks)
                self._cpu[key] = process.cpu_ticks
                ticks += process.cpu_ticks - before.get(key, 0)
            known = any((process.pid, process.started_ticks) in before for process in processes)
            percent = 100.0 * ticks / TICKS_PER_S / elapsed if elapsed and known else None
            usages[name] = Usage(percent, self._memory_of(name, processes, position))
        return usages

    def _memory_of(self, name: str, processes: Sequence[Process], position: int) -> int | None:
        pids = frozenset(process.pid for process in processes)
        known = self._memory.get(name)
        if known is None or known[0] != pids or (self._turn + position) % self._MEMORY_EVERY == 0:
            known = self._memory[name] = (pids, proportional_memory(pids))
        return known[1]


def proportional_memory(pids: Iterable[int]) -> int | None:
    """Return the proportional set size of these processes in bytes, None if it is not told."""
    total = None
    for pid in pids:
        try:
            with open(f"/proc/{pid}/smaps_rollup", "rb") as file:  # noqa: PTH123
                for line in file:
                    if line.startswith(b"Pss:"):
                        total = (total or 0) + int(line.split()[1]) * 1024
                        break
        except OSError:
            continue
    return total
