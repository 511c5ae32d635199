"""What is left of a run when its nodes are gone."""

from __future__ import annotations

import os
import signal
from typing import TYPE_CHECKING

from launcher.processes.members import is_marked
from launcher.processes.signal import send
from launcher.processes.table import processes

if TYPE_CHECKING:
    from collections.abc import Sequence

    from launcher.processes.table import Process
    from launcher.spawn_server.spawner import Spawner


class Orphans:
    """The remaining processes of a run whose nodes are gone; a `launcher.processes.stop.Target`."""

    def __init__(self, run_id: str, spawner: Spawner) -> None:
        """The spawn server is not an orphan: it is needed to the end."""
        self._run_id = run_id
        self._spawner = spawner

    def left(self) -> Sequence[Process]:
        """Return the processes with the run's mark, and the children we have adopted."""
        us = os.getpid()
        return [
            process
            for process in processes()
            if process.pid not in (us, self._spawner.server_pid)
            and not process.zombie
            and (process.parent == us or self._marked(process))
        ]

    def signal(self, process: Process, number: signal.Signals) -> None:
        """Send one of them a signal, and wake it so that it handles it."""
        send(process, number, signal.SIGCONT)

    def _marked(self, process: Process) -> bool:
        return is_marked(process, self._run_id)
