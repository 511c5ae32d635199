"""Which processes belong to which node: its group, its session, and those that left both. What they use."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from typing import TypeAlias

from launcher.processes.signal import Identified
from launcher.processes.table import NODE_MARK, RUN_MARK, TICKS_PER_S, Process, processes, read_marks

_FRESH_S = 0.02
"""What was seen so long ago at most also serves other nodes that are stopping."""


class Members:
    """Finds the processes of a run's nodes, looking through all processes only as often as useful."""

    def __init__(self, run_id: str) -> None:
        """`run_id`: the value of `RUN_MARK` in their environment."""
        self._run_id = run_id
        self._leaders: dict[int, tuple[str, int]] = {}
        """The number of a node's process, and thus of its group and session, to the node and that process's start."""
        self._names: set[str] = set()
        self._known: dict[tuple[int, int], str] = {}
        """Number and start of a process to the node it belongs to.

        That a process belongs to nobody is looked up each time: it may have been seen before its
        node was added, or before it had its marks, however long ago it was started.
        """
        self._found: Mapping[str, Sequence[Process]] = {}
        self._looked_at_s = float("-inf")

    def add(self, name: str, leader: Identified) -> None:
        """Add a node that was started; `leader` is the leader of its group and session."""
        self._leaders[leader.pid] = name, leader.started_ticks
        self._names.add(name)
        self.look_anew()

    def remove(self, leader: int) -> None:
        """Remove a leader of whose group nothing is left."""
        self._leaders.pop(leader, None)

    def look_anew(self) -> None:
        """Forget what was seen: a process was started or has ended."""
        self._looked_at_s = float("-inf")

    def look(self, max_age_s: float = _FRESH_S) -> Mapping[str, Sequence[Process]]:
        """Return the living processes of each node, without zombies."""
        now_s = time.monotonic()
        if now_s - self._looked_at_s > max_age_s:
            self._found, self._looked_at_s = self._scan(), now_s
        return self._found

    def _scan(self) -> dict[str, list[Process]]:
        everybody = {process.pid: process for process in processes()}
        # A number is not reused as long as a group or session has it: then all of these are another's.
        for leader, (_name, started_ticks) in tuple(self._leaders.items()):
            if leader in everybody and everybody[leader].started_ticks != started_ticks:
                self.remove(leader)
        table = {pid: process for pid, process in everybody.items() if not process.zombie}
        found: dict[str, list[Process]] = {}
        known = {}
        for process in table.values():
            key = (process.pid, process.started_ticks)
            name = self._known.get(key) or self._by_descent(process, table) or self._by_marks(process)
            if name:
                known[key] = name
                found.setdefault(name, []).append(process)
        self._known = known
        return found

    def _by_descent(self, process: Process, table: Mapping[int, Process]) -> str | None:
        at: Process | None = process
        for _generation in range(64):
            if at is None:
                return None
            for number in (at.group, at.session, at.pid):
                if number in self._leaders:
                    return self._leaders[number][0]
            at = table.get(at.parent)
        return None

    def _by_marks(self, process: Process) -> str | None:
        marks = read_marks(process.pid)
        if marks is None or marks.get(RUN_MARK) != self._run_id:
            return None
        name = marks.get(NODE_MARK)
        return name if name in self._names else None


def is_marked(process: Process, run_id: str) -> bool:
    """Whether a process is marked in its environment as one of this run."""
    marks = read_marks(process.pid)
    return marks is not None and marks.get(RUN_MARK) == run_id


Usage: TypeAlias = "tuple[float | None, int | None]"
"""Percent of one core since the previous measurement, None at the first one; proportional set size in bytes,
None where the kernel does not provide it."""


class UsageMeter:
    """Measures repeatedly, relative to the previous measurement, all processes of a node together."""

    _MEMORY_EVERY = 3
    """How seldom memory is measured: the kernel walks all pages of a process for it."""

    def __init__(self) -> None:
        self._cpu: dict[tuple[int, int], int] = {}
        self._memory: dict[str, tuple[frozenset[int], int | None]] = {}
        self._measured_at: float | None = None
        self._turn = 0

    def measure(self, members: Mapping[str, Sequence[Process]], now: float) -> dict[str, Usage]:
        """Return the use of every node; `now` is in monotonic seconds."""
        elapsed = None if self._measured_at is None else now - self._measured_at
        before, self._measured_at = self._cpu, now
        self._cpu = {}
        self._turn += 1
        usages = {}
        for position, (name, own) in enumerate(members.items()):
            ticks = 0
            for process in own:
                key = (process.pid, process.started_ticks)
                self._cpu[key] = process.cpu_ticks
                ticks += process.cpu_ticks - before.get(key, 0)
            known = any((process.pid, process.started_ticks) in before for process in own)
            percent = 100.0 * ticks / TICKS_PER_S / elapsed if elapsed and known else None
            usages[name] = percent, self._memory_of(name, own, position)
        return usages

    def _memory_of(self, name: str, own: Sequence[Process], position: int) -> int | None:
        pids = frozenset(process.pid for process in own)
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
