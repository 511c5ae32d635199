"""Short-lived processes that know ROS, and report to the supervisor, which does not."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from typing import TYPE_CHECKING

from launcher.processes.signal import send

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from launcher.processes.exit import Reaper
    from launcher.spawn_server.spawner import SpawnedProcess, Spawner, SpawnRequest

ENDS_WITHIN_S = 3.0


@contextlib.asynccontextmanager
async def helping(spawner: Spawner, reaper: Reaper, request: SpawnRequest) -> AsyncIterator[asyncio.StreamReader]:
    """Start a process for the length of a `with`; yields its stdout, a line a report.

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
            _ = asyncio.create_task(_see_off(spawned, spawner, reaper))  # noqa: RUF006 - it ends by itself


async def _see_off(spawned: SpawnedProcess, spawner: Spawner, reaper: Reaper) -> None:
    ended = reaper.exit_of(spawned.pid, spawned.started_ticks)
    try:
        await asyncio.wait_for(asyncio.shield(ended), ENDS_WITHIN_S)
    except asyncio.TimeoutError:
        send(spawned, signal.SIGKILL)
        await ended
    spawner.forget(spawned.pid)
