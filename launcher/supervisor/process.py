"""The supervisor's processes: those of nodes with all their descendants, orphans, short-lived helpers."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from collections.abc import AsyncIterator, Sequence

from launcher.logs.reader import PipeReader, node_pipe
from launcher.logs.session_log import SessionLog
from launcher.processes.exit import Exit, Reaper, signal_name
from launcher.processes.members import Members, is_marked
from launcher.processes.signal import send
from launcher.processes.table import Process, processes
from launcher.profile.node import Node
from launcher.spawn_server import SpawnRequest
from launcher.spawn_server.spawner import SpawnedProcess, Spawner
from launcher.supervisor.plan import Plan

_ENDS_WITHIN_S = 3.0
"""How long a helper may take to end once its stdin is closed."""


class NodeProcess:
    """One process that was started for a node, with all its descendants."""

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
        members = self._launcher.members
        return members.look().get(self.name) or members.look(0.0).get(self.name, ())

    def look_for_end(self) -> None:
        """Look anew for the end of the process itself, of which nobody has told."""
        self._launcher.reaper.look_for(self.pid, self.started_ticks)

    async def close(self) -> None:
        """Read its last output and forget it."""
        for reader in self._readers:
            reader.close()
        self._launcher.members.remove(self.pid)

    def _on_end(self, _ended: object) -> None:
        self._launcher.members.look_anew()
        for reader in self._readers:
            reader.drain()


async def _inner_exit(ended: asyncio.Future[Exit]) -> Exit:
    """Return how a node ended of which a program with a shell's exit codes tells."""
    outer = await ended
    return Exit(None, signal_name(outer.code - 128)) if outer.code is not None and outer.code > 128 else outer


class ProcessLauncher:
    """Starts processes for nodes, and reads their output into the log."""

    def __init__(self, plan: Plan, spawner: Spawner, reaper: Reaper, members: Members, log: SessionLog) -> None:
        self.spawner = spawner
        self.reaper = reaper
        self.members = members
        self._plan = plan
        self._log = log

    async def launch(self, node: Node) -> NodeProcess:
        """Start a node; raises `SpawnError`."""
        within = () if node.is_ours else self._plan.within
        warm = node.is_forked and not within
        request = SpawnRequest(
            kind="module" if warm else "exec",
            name=node.name,
            title=f"deck: {node.name} ({node.command})",
            argv=(str(node.run), *node.ros_args()) if warm else (*within, *node.argv()),
            cwd=node.cwd or "/",
            env=self._plan.env_of(node),
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
        self.members.add(node.name, spawned)
        return NodeProcess(node.name, spawned, self, readers, confined=bool(within))


def orphans(run_id: str, spawner: Spawner) -> Sequence[Process]:
    """Return the remaining processes of a run whose nodes are gone: with its mark, or adopted by us."""
    # The spawn server is needed to the end.
    needed = (os.getpid(), spawner.server_pid)
    return [
        process
        for process in processes()
        if process.pid not in needed
        and not process.zombie
        and (process.parent == os.getpid() or is_marked(process, run_id))
    ]


@contextlib.asynccontextmanager
async def helping(spawner: Spawner, reaper: Reaper, request: SpawnRequest) -> AsyncIterator[asyncio.StreamReader]:
    """Start a process that knows ROS for the length of a `with`; yields its stdout, a line a report.

    Raises:
        SpawnError: if it cannot be started.
    """
    hold_read, hold = os.pipe()
    report, report_write = os.pipe()
    spawned: SpawnedProcess | None = None
    try:
        try:
            spawned = await spawner.spawn(request, (hold_read, report_write, 2))
        finally:
            os.close(hold_read)
            os.close(report_write)
        reader = asyncio.StreamReader()
        transport, _protocol = await asyncio.get_running_loop().connect_read_pipe(
            lambda: asyncio.StreamReaderProtocol(reader), os.fdopen(os.dup(report), "rb", 0)
        )
        try:
            yield reader
        finally:
            transport.close()
    finally:
        # It ends cleanly when its stdin is closed, and announces that to the graph.
        os.close(hold)
        os.close(report)
        if spawned is not None:
            _ = asyncio.create_task(_see_off(spawned, reaper))  # noqa: RUF006 - it ends by itself


async def _see_off(spawned: SpawnedProcess, reaper: Reaper) -> None:
    ended = reaper.exit_of(spawned.pid, spawned.started_ticks)
    try:
        await asyncio.wait_for(asyncio.shield(ended), _ENDS_WITHIN_S)
    except asyncio.TimeoutError:
        send(spawned, signal.SIGKILL)
        await ended
