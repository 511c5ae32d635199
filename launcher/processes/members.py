"""Which processes belong to which node: its group, its session, and those that left both."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launcher.processes.table import NODE_MARK, RUN_MARK, processes, read_marks

if TYPE_CHECKING:
    from collections.abc import Mapping

    from launcher.processes.signal import Identified
    from launcher.processes.table import Process


class Members:
    """Finds the processes of a run's nodes."""

    def __init__(self, run_id: str) -> None:
        """`run_id`: the value of `RUN_MARK` in their environment."""
        self._run_id = run_id
        self._leaders: dict[int, str] = {}
        """Leader to node: the number of a node's process, and thus of its group and session."""
        self._starts: dict[int, int] = {}
        """The start of each leader, which distinguishes it from a later process with its number."""
        self._names: set[str] = set()
        self._known: dict[tuple[int, int], str] = {}
        """Number and start of a process to the node it belongs to.

        That a process belongs to nobody is looked up each time: it may have been seen before its
        node was added, or before it had its marks, however long ago it was started.
        """

    def add(self, name: str, leader: Identified) -> None:
        """Add a node that was started; `leader` is the leader of its group and session."""
        self._leaders[leader.pid] = name
        self._starts[leader.pid] = leader.started_ticks
        self._names.add(name)

    def remove(self, leader: int) -> None:
        """Remove a leader of whose group nothing is left."""
        self._leaders.pop(leader, None)
        self._starts.pop(leader, None)

    def scan(self) -> dict[str, list[Process]]:
        """Return the living processes of each node, without zombies."""
        everybody = {process.pid: process for process in processes()}
        self._forget_replaced(everybody)
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

    def _forget_replaced(self, everybody: Mapping[int, Process]) -> None:
        """Forget leaders whose number now belongs to another process, group and session.

        The kernel does not reuse a number as long as a group or session has it.
        """
        for leader, started_ticks in tuple(self._starts.items()):
            process = everybody.get(leader)
            if process is not None and process.started_ticks != started_ticks:
                self.remove(leader)

    def _by_descent(self, process: Process, table: Mapping[int, Process]) -> str | None:
        leaders = self._leaders
        at: Process | None = process
        for _generation in range(64):
            if at is None:
                return None
            name = leaders.get(at.group) or leaders.get(at.session) or leaders.get(at.pid)
            if name is not None:
                return name
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
