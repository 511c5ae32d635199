"""A node's process with all its descendants: starting, finding, signalling, releasing."""

from __future__ import annotations

import asyncio
import os
import signal
import time
from typing import TYPE_CHECKING

from launcher.logs.reader import PipeReader, node_pipe
from launcher.processes.exit import Exit, signal_name
from launcher.processes.members import Members
from launcher.processes.signal import send
from launcher.spawn_server.spawner import SpawnRequest

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from launcher.logs.session_log import SessionLog
    from launcher.processes.exit import Reaper
    from launcher.processes.table import Process
    from launcher.spawn_server.spawner import SpawnedProcess, Spawner
    from launcher.supervisor.plan import NodePlan, Plan

_FRESH_S = 0.02
"""A scan of all processes of at most this age also serves other nodes that are stopping."""


class ProcessScan:
    """The processes of all nodes, scanned only as often as useful."""

    def __init__(self, members: Members) -> None:
        self.members = members
        self._found: Mapping[str, Sequence[Process]] = {}
        self._at = float("-inf")

    def look(self, max_age_s: float = _FRESH_S) -> Mapping[str, Sequence[Process]]:
        """Return the living processes of each node."""
        now = time.monotonic()
        if now - self._at > max_age_s:
            self._found, self._at = self.members.scan(), now
        return self._found

    def forget(self) -> None:
        """Drop the cached scan: a process was started or has ended."""
        self._at = float("-inf")


class NodeProcess:
    """One process that was started for a node; a `RunningProcess`."""

    def __init__(
        self,
        name: str,
        spawned: SpawnedProcess,
        launcher: ProcessLauncher,
        readers: Sequence[PipeReader],
        *,
        confined: bool = False,
    ) -> None:
        """`readers` read its stdout and stderr; `confined`: it is the one that confines the node."""
        self.name = name
        self.pid = spawned.pid
        self.started_ticks = spawned.started_ticks
        self.ended: asyncio.Future[Exit] = launcher.reaper.exit_of(spawned.pid, spawned.started_ticks)
        if confined:
            self.ended = asyncio.ensure_future(_inner_exit(self.ended))
        self.ended.add_done_callback(self._on_end)
        self._launcher = launcher
        self._readers = readers

    def left(self) -> Sequence[Process]:
        """Return its living processes; that there are none is not taken from an earlier look."""
        scan = self._launcher.scan
        return scan.look().get(self.name) or scan.look(0.0).get(self.name, ())

    def look_for_end(self) -> None:
        """Look anew for the end of the process itself, of which nobody has told."""
        self._launcher.reaper.look_for(self.pid, self.started_ticks)

    def signal(self, process: Process, number: signal.Signals) -> None:
        """Send one of them a signal, and wake it if it is suspended, so that it handles it."""
        send(process, number, signal.SIGCONT)

    async def close(self) -> None:
        """Read its last output and forget it."""
        for reader in self._readers:
            reader.close()
        self._launcher.scan.members.remove(self.pid)
        self._launcher.spawner.forget(self.pid)

    def _on_end(self, _ended: object) -> None:
        self._launcher.scan.forget()
        for reader in self._readers:
            reader.drain()


async def _inner_exit(ended: asyncio.Future[Exit]) -> Exit:
    """Return how a node ended of which a program with a shell's exit codes tells."""
    outer = await ended
    return Exit(None, signal_name(outer.code - 128)) if outer.code is not None and outer.code > 128 else outer


class ProcessLauncher:
    """Starts processes for nodes, and reads their output into the log."""

    def __init__(self, plan: Plan, spawner: Spawner, reaper: Reaper, scan: ProcessScan, log: SessionLog) -> None:
        self.spawner = spawner
        self.reaper = reaper
        self.scan = scan
        self._plan = plan
        self._log = log

    async def launch(self, node: NodePlan) -> NodeProcess:
        """Start a node; raises `SpawnError`."""
        within = () if node.ours else self._plan.within
        warm = bool(node.module) and not within
        request = SpawnRequest(
            kind="module" if warm else "exec",
            name=node.name,
            title=f"deck: {node.name} ({node.command})",
            argv=node.module if warm else (*within, *node.argv),
            cwd=node.cwd,
            env={**self._plan.env, **node.env},
        )
        out, out_write = node_pipe()
        err, err_write = node_pipe()
        # Read from the beginning: output from before the process is known is its own too.
        readers = [self._log.read(node.name, out, "stdout"), self._log.read(node.name, err, "stderr")]
        try:
            spawned = await self.spawner.spawn(request, (out_write, err_write))
        except BaseException:
            for reader in readers:
                reader.close()
            raise
        finally:
            os.close(out_write)
            os.close(err_write)
        self.scan.members.add(node.name, spawned)
        self.scan.forget()
        return NodeProcess(node.name, spawned, self, readers, confined=bool(within))
