"""The folder of a run, kept in its place for as long as the run lasts.

In /run/user it is removed when the user logs out, and people move or clean up files. So the
supervisor checks it regularly, creates it again, in a place of last resort if necessary, and holds
it open under a fixed descriptor, through which it can be found in /proc wherever it is
(`launcher.runs.record`).
"""

from __future__ import annotations

import asyncio
import os
import socket
import tempfile
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from launcher.control.socket import SOCKET_NAME, listen
from launcher.errors import RunDirError
from launcher.processes.prctl import show_mark
from launcher.processes.table import SUPERVISOR_MARK
from launcher.rundir import own_folder
from launcher.runs.record import RECORD_NAME, RunRecord
from text.sentences import Words, say

LOOK_EVERY_S = 1.0


class RunFolder:
    """The place where clients find a run: its record and its socket."""

    def __init__(self, record: RunRecord) -> None:
        """`record` says where the folder belongs."""
        self.record = record
        """The current record, with the folder that it is in."""
        self._proper = record.folder
        self._descriptor = -1
        self._socket: os.stat_result | None = None

    @property
    def run_dir(self) -> Path:
        """The run directory, in which the folders of runs belong."""
        return self._proper.parent

    def settle(self) -> None:
        """Create the folder and write the record, also findable through the process table."""
        self.record.write()
        self._hold()

    def listen(self) -> socket.socket:
        server = listen(self.record.folder)
        self._socket = os.stat(SOCKET_NAME, dir_fd=self._descriptor)
        return server

    async def keep(self, serve: Callable[[socket.socket], Awaitable[None]], tell: Callable[[Words], None]) -> None:
        """Create it again whenever it disappears; `serve` gets each new socket, `tell` messages."""
        complained = False
        while True:
            await asyncio.sleep(LOOK_EVERY_S)
            if self._is_in_place() and self._is_complete():
                continue
            before = self.record.folder
            try:
                await serve(self._made_again())
            except OSError as problem:
                if not complained:
                    tell(say("{path} is gone and cannot be created again: {problem}", path=before, problem=problem))
                complained = True
            else:
                now = self.record.folder
                tell(say("{path} is gone; the session is now in {now}", path=before, now=now))
                complained = False

    def remove(self) -> None:
        """Remove the folder, and stop advertising it through the process table."""
        self.record.remove()
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1

    def _is_in_place(self) -> bool:
        """Whether the folder held open is still the one at this path."""
        with suppress(OSError):
            return os.path.samestat(os.fstat(self._descriptor), self.record.folder.stat())
        return False

    def _is_complete(self) -> bool:
        with suppress(OSError):
            (self.record.folder / RECORD_NAME).lstat()
            there = os.stat(SOCKET_NAME, dir_fd=self._descriptor)
            return self._socket is not None and os.path.samestat(there, self._socket)
        return False

    def _made_again(self) -> socket.socket:
        """Create folder, record and socket, in a place of last resort if necessary."""
        try:
            own_folder(self.run_dir)
            self.record = replace(self.record, folder=self._proper)
            self.settle()
        except (OSError, RunDirError):
            self.record = replace(self.record, folder=Path(tempfile.mkdtemp(prefix="deck-")))
            self.settle()
        return self.listen()

    def _hold(self) -> None:
        """Hold the folder open, under the same descriptor number as the one before."""
        descriptor = os.open(self.record.folder, os.O_PATH | os.O_DIRECTORY | os.O_CLOEXEC)
        if self._descriptor < 0:
            self._descriptor = descriptor
            session = self.record.session
            show_mark(SUPERVISOR_MARK, f"{session.run_id}/{session.domain}/{descriptor}")
        else:
            os.dup2(descriptor, self._descriptor, inheritable=False)
            os.close(descriptor)
