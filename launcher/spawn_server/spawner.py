"""How the supervisor starts processes: by asking the spawn server, which is replaced if it dies."""

from __future__ import annotations

import asyncio
import contextlib
import signal
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from launcher.processes.signal import send
from launcher.spawn_server.link import SpawnServerLink
from launcher.spawn_server.start import SpawnServerHandle, start_spawn_server
from text.os_words import os_reason
from text.sentences import Words, say

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

MAX_ATTEMPTS = 4
"""Attempts for one request, each with a new spawn server if the last one died."""
MAX_HANGS = 2
"""How many of them may fail to answer."""
MAX_QUICK_DEATHS = 3
"""After this many spawn servers without a single answer, the next one is cold (no imports)."""
ANSWER_WITHIN_S = 30.0
"""On a slow machine the imports may take a large part of this."""


class SpawnError(Exception):
    """A process could not be started; the argument says why."""


@dataclass(frozen=True)
class SpawnRequest:
    """One process to be started."""

    kind: str
    """`module`, `exec`, `probe` or `lifecycle`, see `launcher.spawn_server.node.ForkSpec`."""
    name: str
    title: str
    argv: tuple[str, ...]
    cwd: str
    env: Mapping[str, str | None] = field(default_factory=dict)
    """Changes to the supervisor's environment; None unsets."""


@dataclass(frozen=True)
class SpawnedProcess:
    """A started process: the leader of its own session and group, and our child."""

    pid: int
    started_ticks: int


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
        self._groups: set[int] = set()
        self._closed = False
        self._packages: list[str] = []
        self._link: SpawnServerLink | None = self._linked(server)

    @property
    def server_pid(self) -> int | None:
        """The process number of the current server."""
        return None if self._link is None else self._link.handle.pid

    async def spawn(self, request: SpawnRequest, fds: Sequence[int]) -> SpawnedProcess:
        """Start a process with these descriptors, which the caller still has to close.

        If the caller stops waiting (is cancelled), a process that is then started is ended again.

        Args:
            request: what to start.
            fds: its stdout and stderr, or its stdin, stdout and stderr.

        Raises:
            SpawnError: if the process was not started.
        """
        hangs = 0
        for _attempt in range(MAX_ATTEMPTS):
            link = self._present()
            spawned = await self._ask(link, request, fds)
            if spawned is not None:
                self._groups.add(spawned.pid)
                self._mention("adopt", [spawned.pid])  # A new server gets all existing groups.
                return spawned
            hangs += link.hung
            if hangs == MAX_HANGS:
                raise SpawnError(say("the spawn server does not answer"))
        raise SpawnError(say("the spawn server keeps ending"))

    async def _ask(self, link: SpawnServerLink, request: SpawnRequest, fds: Sequence[int]) -> SpawnedProcess | None:
        """Return the new process, None if the server died before answering.

        Anything it forked has been answered before: the end of the socket comes after all answers.
        """
        request_id, self._next_id = self._next_id, self._next_id + 1
        future: asyncio.Future[SpawnedProcess | None] = asyncio.get_running_loop().create_future()
        self._pending[request_id] = future
        try:
            link.tell({"id": request_id, **vars(request)}, fds)
            await asyncio.wait([future], timeout=self._answer_within_s)
            if not future.done():
                link.kill(hung=True)
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

    def forget(self, pid: int) -> None:
        """Note that a started process and its group no longer exist."""
        if pid in self._groups:
            self._groups.discard(pid)
            self._mention("forget", [pid])

    def preload(self, packages: Iterable[str]) -> None:
        """Have the shared modules of these packages imported before their first node starts."""
        self._packages = sorted(packages)
        self._mention_packages()

    def go_cold(self) -> None:
        """Replace the server with one that imports nothing: no node of this run needs them."""
        self._warm = False
        if self._link is not None:
            self._link.kill()
            self._link.drop()
        self._replace()

    def close(self) -> None:
        """Release the server; nothing of the run is left that it would have to end."""
        self._closed = True
        if self._link is not None:
            # It may be in the middle of its imports, or not respond at all.
            self._link.kill()
            self._link.drop()
            self._link = None
        for future in self._pending.values():
            if not future.done():
                future.set_exception(SpawnError(_ending()))

    def _present(self) -> SpawnServerLink:
        """Return the current server, or a new one if there is none."""
        if self._closed:
            raise SpawnError(_ending())
        if self._link is None:
            self._replace()
        if self._link is None:
            raise SpawnError(say("there is no spawn server"))
        return self._link

    def _linked(self, server: SpawnServerHandle) -> SpawnServerLink:
        return SpawnServerLink(server, self._answered, self._ended)

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

    def _ended(self, link: SpawnServerLink) -> None:
        self._link = None
        for future in self._pending.values():
            if not future.done():
                future.set_result(None)
        if self._closed:
            return
        self._quick_deaths += 1
        if self._quick_deaths >= MAX_QUICK_DEATHS or (link.hung and not link.answered):
            self._warm = False
        self._tell(_why_replaced(link, self._answer_within_s))
        self._replace()

    def _replace(self) -> None:
        try:
            self._link = self._linked(start_spawn_server(self._run_id, warm=self._warm))
        except OSError as problem:
            self._link = None
            self._tell(say("no spawn server can be started: {reason}", reason=os_reason(problem)))
            return
        self._mention("adopt", sorted(self._groups))
        self._mention_packages()

    def _mention(self, kind: str, groups: list[int]) -> None:
        if self._link is not None and groups:
            with contextlib.suppress(OSError):
                self._link.tell({"kind": kind, "groups": groups})

    def _mention_packages(self) -> None:
        if self._link is not None and self._packages and self._warm:
            with contextlib.suppress(OSError):
                self._link.tell({"kind": "preload", "packages": self._packages})


def _end(spawned: SpawnedProcess | None) -> None:
    """End a started process that is no longer wanted."""
    if spawned is not None:
        send(spawned, signal.SIGKILL)


def _ending() -> Words:
    return say("the session is ending")


def _why_replaced(link: SpawnServerLink, within_s: float) -> Words:
    pid = link.handle.pid
    if link.hung:
        return say(
            "the spawn server (pid {pid}) did not answer within {seconds:g} s and was killed; a new one takes over",
            pid=pid,
            seconds=within_s,
        )
    return say("the spawn server (pid {pid}) ended; a new one takes over", pid=pid)
