"""Watching the learner's own files: a node is restarted once its file has been saved.

Editors write in bursts, by way of a temporary file, or empty a file before they fill it: a restart
follows the last write by `QUIET_S`, and an empty file counts as not yet written. What is saved
while nothing is watched yet, as in the first moments of a run, is found by comparing each file with
what it was when its node was started.
"""

from __future__ import annotations

import asyncio
import os
import time
from collections.abc import Callable, Iterable, Mapping

from launcher.status import NodeFault

QUIET_S = 0.5
"""From the last write to the restart."""
STEP_MS = 50
AGAIN_S = 1.0
"""When to look again for a folder that is not there."""
ENDING = ".py"
_Stamp = tuple[int, int, int]


class OwnFiles:
    """The files of the nodes that are the learner's own."""

    def __init__(
        self, file_of: Callable[[], Mapping[str, str]], saved: Callable[[str, NodeFault | None], None]
    ) -> None:
        """`file_of`: each such node's file; `saved` is called with a node whose file was saved."""
        self._file_of = file_of
        self._saved = saved
        self._started: dict[str, dict[str, _Stamp]] = {}
        """Node to its files as they were when it was started, or last looked at."""
        self._changed = asyncio.Event()
        self._pending: set[str] = set()
        """Files that were written and are not quiet yet."""
        self._timer: asyncio.TimerHandle | None = None

    def look_again(self) -> None:
        """Note that other files are to be watched from now on."""
        self._changed.set()

    def note(self, node: str, file: str) -> None:
        """Note that this node is about to be started from this file."""
        from launcher.faults.source import modules_of  # Large, and only learners need it.

        self._started[node] = {path: _stamp(path) for path in (file, *modules_of(file))}

    async def watch(self) -> None:
        try:
            while True:
                self._changed.clear()
                folders = {file.rpartition("/")[0] for file in self._file_of().values()}
                if not folders:
                    await self._changed.wait()
                    continue
                await self._watch(folders)
        finally:
            if self._timer is not None:
                self._timer.cancel()

    async def _watch(self, folders: Iterable[str]) -> None:
        """Watch these folders until others are to be watched."""
        # It is large, and only learners need it.
        from watchfiles import awatch

        loop = asyncio.get_running_loop()
        stop = asyncio.Event()
        ending = asyncio.ensure_future(self._changed.wait())
        ending.add_done_callback(lambda _ended: stop.set())
        there = [folder for folder in folders if os.path.isdir(folder)]  # noqa: ASYNC240, PTH112
        if not there:
            await asyncio.sleep(AGAIN_S)
            return
        # Run as soon as the first step below waits: by then these folders are watched.
        loop.call_soon(self._find_missed)
        try:
            async for changes in awatch(*there, step=STEP_MS, stop_event=stop, recursive=False):
                self._wait_for_quiet({path for _kind, path in changes if path.endswith(ENDING)})
        finally:
            ending.cancel()

    def _find_missed(self) -> None:
        for node, file in self._file_of().items():
            stamps = self._started.get(node, {})
            if file in stamps:
                self._wait_for_quiet({path for path in stamps if stamps[path] != _stamp(path)})

    def _wait_for_quiet(self, written: set[str]) -> None:
        if not written:
            return
        self._pending |= written
        if self._timer is not None:
            self._timer.cancel()
        quiet_s = QUIET_S - min(map(_age_s, written))
        self._timer = asyncio.get_running_loop().call_later(max(quiet_s, 0.0), self._restart)

    def _restart(self) -> None:
        from launcher.faults.source import look_at, modules_of

        written, self._pending = self._pending, set()
        for node, file in self._file_of().items():
            if (file in written or written & modules_of(file)) and _stamp(file)[2]:
                self.note(node, file)
                self._saved(node, look_at(file))


def _stamp(file: str) -> _Stamp:
    """Return what differs once a file has been written or replaced; zeros if it is not there."""
    try:
        status = os.stat(file)  # noqa: PTH116
    except OSError:
        return 0, 0, 0
    return status.st_ino, status.st_ctime_ns, status.st_size


def _age_s(file: str) -> float:
    """Return how long ago a file was written, or put in its place; 0 if it is not there."""
    changed_ns = _stamp(file)[1]
    return max(time.time() - changed_ns / 1e9, 0.0) if changed_ns else 0.0
