"""Resource use of nodes: CPU time and memory of all their processes together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from launcher.processes.table import TICKS_PER_S

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from launcher.processes.table import Process


@dataclass(frozen=True)
class Usage:
    """The resource use of one node."""

    cpu_percent: float | None
    """Percent of one core since the previous measurement; None at the first one."""
    memory_bytes: int | None
    """Proportional set size in bytes; None where the kernel does not provide it."""


class UsageMeter:
    """Measures repeatedly, relative to the previous measurement."""

    _MEMORY_EVERY = 3
    """How seldom memory is measured: the kernel walks all pages of a process for it."""

    def __init__(self) -> None:
        self._cpu: dict[tuple[int, int], int] = {}
        self._memory: dict[str, tuple[frozenset[int], int | None]] = {}
        self._measured_at: float | None = None
        self._turn = 0

    def measure(self, members: Mapping[str, Sequence[Process]], now: float) -> dict[str, Usage]:
        """Measure every node; `now` is in monotonic seconds."""
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
    """Return the proportional set size of these processes in bytes, None if not available."""
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
