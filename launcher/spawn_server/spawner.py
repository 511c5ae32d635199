"""The supervisor's way to processes: asks the spawn server for them, and replaces a dead one."""

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
"""So many spawn servers may die over one request."""
MAX_HANGS = 2
"""So many may leave it without an answer."""
MAX_QUICK_DEATHS = 3
"""After so many spawn servers that answered nothing, the next one is cold: it imports nothing."""
ANSWER_WITHIN_S = 30.0
"""What it has to import may take a slow machine a good part of that."""


class SpawnError(Exception):
    """A process could not be started; its argument says why."""


@dataclass(frozen=True)
class SpawnRequest:
    """One process to be started."""

    kind: str
    """`module`, `exec` or `probe`, see `launcher.spawn_server.node.Birth`."""
    name: str
    title: str
    argv: tuple[str, ...]
    cwd: str
    env: Mapping[str, str | None] = field(default_factory=dict)
    """What differs from the supervisor's environment; None unsets."""


@dataclass(frozen=True)
class Born:
    """A process that has been started: the leader of its own session and group, and our child."""

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
        """`tell` hears of every server that died or did not answer, and was replaced."""
        self._run_id = run_id
        self._tell = tell
        self._answer_within_s = answer_within_s
        self._warm = server.warm
        self._pending: dict[int, asyncio.Future[Born | None]] = {}
        self._next_id = 1
        self._quick_deaths = 0
        self._groups: set[int] = set()
        self._closed = False
        self._packages: list[str] = []
        self._link: SpawnServerLink | None = self._linked(server)

    @property
    def server_pid(self) -> int | None:
        """The process number of the present server."""
        return None if self._link is None else self._link.handle.pid

    async def spawn(self, request: SpawnRequest, fds: Sequence[int]) -> Born:
        """Start a process on these descriptors, which stay the caller's to close.

        Whoever no longer waits for it need not care: a process that comes then is ended.

        Args:
            request: what to start.
            fds: its stdout and stderr, or its stdin, stdout and stderr.

        Raises:
            SpawnError: if there is no such process now.
        """
        hangs = 0
        for _attempt in range(MAX_ATTEMPTS):
            link = self._present()
            born = await self._ask(link, request, fds)
            if born is not None:
                self._groups.add(born.pid)
                self._mention("adopt", [born.pid])  # A new server is told which groups there are.
                return born
            hangs += link.hung
            if hangs == MAX_HANGS:
                raise SpawnError(say("the spawn server does not answer"))
        raise SpawnError(say("the spawn server ends again and again"))

    async def _ask(
        self, link: SpawnServerLink, request: SpawnRequest, fds: Sequence[int]
    ) -> Born | None:
        """Return the new process, None if the server has died over it.

        What it had forked has answered before: the end of the socket comes after all answers.
        """
        request_id, self._next_id = self._next_id, self._next_id + 1
        future: asyncio.Future[Born | None] = asyncio.get_running_loop().create_future()
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
        """Say that a started process and its group are no more."""
        if pid in self._groups:
            self._groups.discard(pid)
            self._mention("forget", [pid])

    def preload(self, packages: Iterable[str]) -> None:
        """Have these packages' shared modules imported ahead, before the first node of theirs."""
        self._packages = sorted(packages)
        self._mention_packages()

    def go_cold(self) -> None:
        """Replace the server by one that imports nothing: no node of this run needs it warm."""
        self._warm = False
        if self._link is not None:
            self._link.kill()
            self._link.drop()
        self._replace()

    def close(self) -> None:
        """Let go of the server; nothing of the run is left that it would have to end."""
        self._closed = True
        if self._link is not None:
            # It may be in the midst of its imports, or not hear at all.
            self._link.kill()
            self._link.drop()
            self._link = None
        for future in self._pending.values():
            if not future.done():
                future.set_exception(SpawnError(_ending()))

    def _present(self) -> SpawnServerLink:
        """Return the server, a new one if there is none."""
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
        born = Born(answer["pid"], answer["started"]) if "pid" in answer else None
        future = self._pending.get(answer["id"])
        if future is None or future.done():
            _end(born)
        elif born is not None:
            future.set_result(born)
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
        self._tell(_obituary(link, self._answer_within_s))
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


def _end(born: Born | None) -> None:
    """End a process that nobody waits for any more."""
    if born is not None:
        send(born, signal.SIGKILL)


def _ending() -> Words:
    return say("the session is ending")


def _obituary(link: SpawnServerLink, within_s: float) -> Words:
    pid = link.handle.pid
    if link.hung:
        return say(
            "the spawn server (pid {pid}) gave no answer for {seconds:g} s and was killed; the"
            " next starts use a new one",
            pid=pid,
            seconds=within_s,
        )
    return say("the spawn server (pid {pid}) ended; the next starts use a new one", pid=pid)
