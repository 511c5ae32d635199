"""How the supervisor starts processes: by asking the spawn server, which is replaced if it dies."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import json
import os
import signal
import socket
import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from launcher.processes.signal import send
from launcher.spawn_server import SpawnRequest
from launcher.spawn_server.start import SpawnServerHandle, start_spawn_server
from text.nested import read_json
from text.os_words import os_reason
from text.sentences import Words, say

MAX_ATTEMPTS = 3
ROOM_EVERY_S = 0.01
"""Attempts for one request, each with a new spawn server if the last one died, or did not answer."""
MAX_QUICK_DEATHS = 3
"""After this many spawn servers without a single answer, the next one is cold (no imports)."""
ANSWER_WITHIN_S = 30.0
"""On a slow machine the imports may take a large part of this."""
MAX_ANSWER = 65536


class SpawnError(Exception):
    """A process could not be started; the argument says why."""


class SpawnedProcess(NamedTuple):
    """A started process: the leader of its own session and group, and our child."""

    pid: int
    started_ticks: int


class _Server:
    """One spawn server, for as long as its socket is open."""

    def __init__(
        self,
        handle: SpawnServerHandle,
        on_answer: Callable[[dict[str, Any]], None],
        on_end: Callable[[_Server], None],
    ) -> None:
        """`on_end` is called once, after its last answer, when the server has died."""
        self.handle = handle
        self.answered = False
        """Whether it has ever answered."""
        self.hung = False
        """Whether it was killed because it did not answer in time."""
        self._on_answer, self._on_end = on_answer, on_end
        asyncio.get_running_loop().add_reader(handle.link, self._read)

    def told(self, message: dict[str, object], fds: Sequence[int]) -> bool:
        """Send a message, with copies of descriptors; return False if there is no room for it now."""
        # In a memory file, as a packet is limited to some 200 kB, less than a command line may need.
        with os.fdopen(os.memfd_create("deck message"), "wb") as file:
            file.write(json.dumps(message).encode())
            file.flush()
            try:
                # If it is dead, the reading side will notice after its last answers.
                with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                    socket.send_fds(self.handle.link, [b"."], [file.fileno(), *fds])
            except OSError as problem:
                if problem.errno not in (errno.EAGAIN, errno.ETOOMANYREFS):
                    raise
                return False
        return True

    def kill(self, *, hung: bool = False) -> None:
        """Kill the server; answers that it has already sent are still read."""
        self.hung = self.hung or hung
        send(self.handle, signal.SIGKILL)

    def drop(self) -> None:
        asyncio.get_running_loop().remove_reader(self.handle.link)
        self.handle.link.close()

    def _read(self) -> None:
        try:
            packet = self.handle.link.recv(MAX_ANSWER)
        except BlockingIOError:
            return
        except OSError:
            packet = b""
        if packet:
            self.answered = True
            self._on_answer(read_json(packet))
        else:
            self.drop()
            self._on_end(self)


class Spawner:
    """Starts processes through the spawn server."""

    def __init__(
        self,
        run_id: str,
        server: SpawnServerHandle,
        tell: Callable[[Words], None],
        answer_within_s: float = ANSWER_WITHIN_S,
    ) -> None:
        """`tell` is called for every server that died or did not answer and was replaced."""
        self._run_id = run_id
        self._tell = tell
        self._answer_within_s = answer_within_s
        self._warm = server.warm
        self._pending: dict[int, asyncio.Future[SpawnedProcess | None]] = {}
        self._next_id = 1
        self._quick_deaths = 0
        self._closed = False
        self._server: _Server | None = _Server(server, self._answered, self._ended)

    @property
    def server_pid(self) -> int | None:
        """The process number of the current server."""
        return None if self._server is None else self._server.handle.pid

    async def spawn(self, request: SpawnRequest, fds: Sequence[int]) -> SpawnedProcess:
        """Start a process with these descriptors, which the caller still has to close.

        If the caller stops waiting (is cancelled), a process that is then started is ended again.

        Args:
            request: what to start.
            fds: its stdout and stderr, or its stdin, stdout and stderr.

        Raises:
            SpawnError: if the process was not started.
        """
        for _attempt in range(MAX_ATTEMPTS):
            spawned = await self._ask(self._present(), request, fds)
            if spawned is not None:
                return spawned
        raise SpawnError(say("the spawn server keeps ending"))

    async def _ask(self, server: _Server, request: SpawnRequest, fds: Sequence[int]) -> SpawnedProcess | None:
        """Return the new process, None if the server died before answering.

        Anything it forked has been answered before: the end of the socket comes after all answers.
        """
        request_id, self._next_id = self._next_id, self._next_id + 1
        future: asyncio.Future[SpawnedProcess | None] = asyncio.get_running_loop().create_future()
        self._pending[request_id] = future
        try:
            # A server that imports something reads nothing meanwhile, and one that has ended never will.
            until_s = time.monotonic() + self._answer_within_s
            message = {"id": request_id, **vars(request)}
            while not (future.done() or server.told(message, fds) or time.monotonic() > until_s):
                await asyncio.wait([future], timeout=ROOM_EVERY_S)
            await asyncio.wait([future], timeout=self._answer_within_s)
            if not future.done():
                server.kill(hung=True)
                await asyncio.wait([future], timeout=self._answer_within_s)
        except OSError as problem:
            raise SpawnError(os_reason(problem)) from problem
        except asyncio.CancelledError:
            if future.done() and future.exception() is None:
                _end(future.result())
            raise
        finally:
            del self._pending[request_id]
        if not future.done():
            raise SpawnError(say("the spawn server does not answer"))
        return future.result()

    def go_cold(self) -> None:
        """Replace the server with one that imports nothing: no node of this run needs them."""
        self._warm = False
        if self._server is not None:
            self._server.kill()
            self._server.drop()
        self._replace()

    def close(self) -> None:
        """Release the server; nothing of the run is left that it would have to end."""
        self._closed = True
        if self._server is not None:
            # It may be in the middle of its imports, or not respond at all.
            self._server.kill()
            self._server.drop()
            self._server = None
        for future in self._pending.values():
            if not future.done():
                future.set_exception(SpawnError(_ending()))

    def _present(self) -> _Server:
        """Return the current server, or a new one if there is none."""
        if self._closed:
            raise SpawnError(_ending())
        if self._server is None:
            self._replace()
        if self._server is None:
            raise SpawnError(say("there is no spawn server"))
        return self._server

    def _answered(self, answer: dict[str, Any]) -> None:
        self._quick_deaths = 0
        spawned = SpawnedProcess(answer["pid"], answer["started"]) if "pid" in answer else None
        future = self._pending.get(answer["id"])
        if future is None or future.done():
            _end(spawned)
        elif spawned is not None:
            future.set_result(spawned)
        else:
            future.set_exception(SpawnError(answer["error"]))

    def _ended(self, server: _Server) -> None:
        self._server = None
        for future in self._pending.values():
            if not future.done():
                future.set_result(None)
        if self._closed:
            return
        self._quick_deaths += 1
        if self._quick_deaths >= MAX_QUICK_DEATHS or (server.hung and not server.answered):
            self._warm = False
        self._tell(_why_replaced(server, self._answer_within_s))
        self._replace()

    def _replace(self) -> None:
        try:
            server = start_spawn_server(self._run_id, warm=self._warm)
            self._server = _Server(server, self._answered, self._ended)
        except OSError as problem:
            self._server = None
            self._tell(say("no spawn server can be started: {reason}", reason=os_reason(problem)))


def _end(spawned: SpawnedProcess | None) -> None:
    """End a started process that is no longer wanted."""
    if spawned is not None:
        send(spawned, signal.SIGKILL)


def _ending() -> Words:
    return say("the session is ending")


def _why_replaced(server: _Server, within_s: float) -> Words:
    pid = server.handle.pid
    if server.hung:
        return say(
            "the spawn server (pid {pid}) did not answer within {seconds:g} s and was killed; a new one takes over",
            pid=pid,
            seconds=within_s,
        )
    return say("the spawn server (pid {pid}) ended; a new one takes over", pid=pid)
