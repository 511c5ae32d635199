"""The supervisor's end of the spawn server: asks for processes, and replaces a dead server."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import signal
import socket
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from launcher.spawn_server_start import SpawnServerHandle, start_spawn_server

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

MAX_ATTEMPTS = 4
"""So many spawn servers may die over one request."""
MAX_QUICK_DEATHS = 3
"""After so many spawn servers that answered nothing, the next one is cold: it imports nothing."""


_QUEUE_FULL_S = 0.01
_ENDING = "the session is ending"


class SpawnError(Exception):
    """A process could not be started; the text says why."""


@dataclass(frozen=True)
class SpawnRequest:
    """One process to be started."""

    kind: str
    """`module`, `exec` or `probe`, see `launcher.spawn_server_node.Birth`."""
    name: str
    title: str
    argv: tuple[str, ...]
    cwd: str
    env: Mapping[str, str | None] = field(default_factory=dict)
    """What differs from the supervisor's environment; None unsets."""


class Spawner:
    """Starts processes through the spawn server."""

    def __init__(
        self, run_id: str, server: SpawnServerHandle, on_death: Callable[[int], None]
    ) -> None:
        """`on_death` is called with the number of a server that died and was replaced."""
        self._run_id = run_id
        self._server = server
        self._on_death = on_death
        self._warm = server.warm
        self._pending: dict[int, asyncio.Future[int | None]] = {}
        self._next_id = 1
        self._quick_deaths = 0
        self._groups: set[int] = set()
        self._closed = False
        self._packages: list[str] = []
        self._listen()

    @property
    def server_pid(self) -> int:
        """The process number of the present server."""
        return self._server.pid

    async def spawn(self, request: SpawnRequest, fds: Sequence[int]) -> int:
        """Start a process on these descriptors, which stay the caller's to close.

        Args:
            request: what to start.
            fds: its stdout and stderr, or its stdin, stdout and stderr.

        Returns:
            Its number. It is the leader of its own session and group, and our own child.

        Raises:
            SpawnError: if there is no such process now.
        """
        for _attempt in range(MAX_ATTEMPTS):
            pid = await self._ask(request, fds)
            if pid is not None:
                break
        else:
            raise SpawnError("the spawn server ends again and again")
        self._groups.add(pid)
        with contextlib.suppress(OSError):  # A new server is told which groups there are.
            await self._send(json.dumps({"kind": "adopt", "groups": [pid]}).encode(), ())
        return pid

    async def _ask(self, request: SpawnRequest, fds: Sequence[int]) -> int | None:
        """Return the number of the new process, None if the server has died over it.

        What it had forked has answered before: the end of the socket comes after all answers.
        """
        if self._closed:
            raise SpawnError(_ENDING)
        request_id, self._next_id = self._next_id, self._next_id + 1
        future: asyncio.Future[int | None] = asyncio.get_running_loop().create_future()
        self._pending[request_id] = future
        packet = json.dumps({"id": request_id, **vars(request)}).encode()
        try:
            with contextlib.suppress(OSError):
                await self._send(packet, fds)
            return await future
        finally:
            self._pending.pop(request_id, None)

    async def forget(self, pid: int) -> None:
        """Say that a started process and its group are no more."""
        if pid in self._groups:
            self._groups.discard(pid)
            with contextlib.suppress(OSError):
                await self._send(json.dumps({"kind": "forget", "groups": [pid]}).encode(), ())

    def preload(self, packages: Iterable[str]) -> None:
        """Have these packages' shared modules imported ahead, before the first node of theirs."""
        self._packages = sorted(packages)
        self._tell_packages()

    def _tell_packages(self) -> None:
        if self._packages and self._warm:
            message = {"kind": "preload", "packages": self._packages}
            self._server.link.send(json.dumps(message).encode())

    def go_cold(self) -> None:
        """Replace the server by one that imports nothing: no node of this run needs it warm."""
        self._warm = False
        # It is in the midst of its imports, and would read a dismissal only after them.
        os.kill(self._server.pid, signal.SIGKILL)
        self._drop()
        self._replace()

    def close(self) -> None:
        """Let go of the server; nothing of the run is left that it would have to end."""
        self._closed = True
        self._dismiss()
        for future in self._pending.values():
            if not future.done():
                future.set_exception(SpawnError(_ENDING))

    async def _send(self, packet: bytes, fds: Sequence[int]) -> None:
        while not self._try_send(packet, fds):  # noqa: ASYNC110 - writable is not empty enough
            # It is busy importing, and its queue is full: a matter of a second at most.
            await asyncio.sleep(_QUEUE_FULL_S)

    def _try_send(self, packet: bytes, fds: Sequence[int]) -> bool:
        try:
            socket.send_fds(self._server.link, [packet], fds)
        except BlockingIOError:
            return False
        return True

    def _listen(self) -> None:
        asyncio.get_running_loop().add_reader(self._server.link, self._read)

    def _read(self) -> None:
        try:
            packet = self._server.link.recv(65536)
        except BlockingIOError:
            return
        except OSError:
            packet = b""
        if not packet:
            self._died()
            return
        self._quick_deaths = 0
        answer: dict[str, Any] = json.loads(packet)
        future = self._pending.get(answer["id"])
        if future is None or future.done():
            return
        if "pid" in answer:
            future.set_result(answer["pid"])
        else:
            future.set_exception(SpawnError(answer["error"]))

    def _died(self) -> None:
        dead = self._server.pid
        self._drop()
        for future in self._pending.values():
            if not future.done():
                future.set_result(None)
        if self._closed:
            return
        self._quick_deaths += 1
        if self._quick_deaths >= MAX_QUICK_DEATHS:
            self._warm = False
        self._replace()
        self._on_death(dead)

    def _dismiss(self) -> None:
        with contextlib.suppress(OSError):
            self._server.link.send(b'{"kind": "dismiss"}')
        self._drop()

    def _drop(self) -> None:
        loop = asyncio.get_running_loop()
        loop.remove_reader(self._server.link)
        self._server.link.close()

    def _replace(self) -> None:
        self._server = start_spawn_server(self._run_id, warm=self._warm)
        if self._groups:
            adopt = json.dumps({"kind": "adopt", "groups": sorted(self._groups)})
            self._server.link.send(adopt.encode())
        self._tell_packages()
        self._listen()
