"""The spawn server: a child of the supervisor from which all nodes are forked.

The first one is forked from the supervisor before that has imported anything; later ones are
started as `python -m launcher.spawn_server.server FD PID MODE ROOM`: FD is its end of a seqpacket
socket, PID the supervisor, MODE `warm` or `cold`, and ROOM a filler that makes room for titles
(`launcher.processes.title`).

A message is one packet of descriptors: first that of a memory file with a JSON object, then, for a
request, the new process's stdin (optional), stdout and stderr. The answer is a packet of JSON,
`{"id": ..., "pid": ..., "started": ...}` with the start in ticks, or `{"id": ..., "error": ...}`. A
node is forked by an intermediate process that exits, so that it becomes a child of the supervisor.

When the socket is closed the supervisor is gone, and this process, which outlives it, ends
everything it has left running: the nodes died with the supervisor (PDEATHSIG), but their children and what left the
nodes' groups did not.
"""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import socket
import sys
from typing import TYPE_CHECKING, Any

from launcher.processes.abandoned import end_all
from launcher.processes.table import RUN_MARK, processes, read_marks, read_process
from launcher.spawn_server.node import ENDING, ForkSpec, become
from launcher.spawn_server.preload import Preload
from text.nested import read_json

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from launcher.processes.table import Process

MAX_FDS = 4
COLLECT_EVERY_S = 0.05
"""How often to check while intermediate processes have not been reaped yet."""


class SpawnServer:
    """Answers the supervisor's requests until the supervisor is gone."""

    def __init__(self, link: socket.socket, supervisor: int, preload: Preload) -> None:
        """`preload`: the imports to complete before warm nodes can be forked."""
        self._link = link
        self._supervisor = supervisor
        self._preload = preload
        self._intermediates: set[int] = set()
        self._waiting: list[tuple[dict[str, Any], list[int]]] = []
        self.groups: set[int] = set()

    def serve(self) -> Callable[[], None] | None:
        """Serve until the socket is closed.

        Returns:
            None at the end; in a forked process, the function it has to run next.
        """
        while True:
            if self._preload.done and self._waiting:
                task = self._fork(*self._waiting.pop(0))
            elif self._request_is_there():
                packet, fds, _flags, _address = socket.recv_fds(self._link, 1, MAX_FDS)
                if not packet:
                    return None
                task = self._take(_read(fds[0]), fds[1:])
            else:
                self._preload.step()
                task = None
            if task is not None:
                return task

    def _request_is_there(self) -> bool:
        """Wait for a request, but not while there are imports left."""
        timeout = self._preload.wait_s
        if self._intermediates:
            self._collect()
            timeout = COLLECT_EVERY_S if timeout is None else timeout
        return bool(select.select([self._link], [], [], timeout)[0])

    def _take(self, request: dict[str, Any], fds: list[int]) -> Callable[[], None] | None:
        if request["kind"] == "adopt":
            self.groups.update(request["groups"])
            return None
        if request["kind"] == "preload":
            self._preload.also(request["packages"])
            return None
        if request["kind"] == "forget":
            self.groups.difference_update(request["groups"])
            return None
        if request["kind"] != "exec" and not self._preload.done:
            self._waiting.append((request, fds))
            return None
        return self._fork(request, fds)

    def _fork(self, request: dict[str, Any], fds: list[int]) -> Callable[[], None] | None:
        spec = ForkSpec.from_request(request, fds, self._supervisor, self._preload)
        try:
            pid = os.fork()
        except OSError as problem:
            _answer(self._link, {"id": request["id"], "error": problem.strerror})
        else:
            if pid == 0:
                self._waiting.clear()
                return _fork_on(spec, self._link, request["id"])
            self._intermediates.add(pid)
        for fd in fds:
            os.close(fd)
        return None

    def _collect(self) -> None:
        for pid in tuple(self._intermediates):
            if os.waitpid(pid, os.WNOHANG)[0] == pid:
                self._intermediates.remove(pid)


def _read(fd: int) -> dict[str, Any]:
    with open(fd, "rb") as file:
        file.seek(0)
        message: dict[str, Any] = read_json(file.read())
    return message


def _fork_on(spec: ForkSpec, link: socket.socket, request_id: int) -> Callable[[], None]:
    """Fork the node, answer the request, and exit; only the node returns from this function.

    The server does not wait for this: meanwhile it handles the next request.
    """
    try:
        pid = os.fork()
    except OSError as problem:
        _answer(link, {"id": request_id, "error": problem.strerror})
        os._exit(1)
    if pid:
        node = read_process(pid)
        assert node is not None, "nobody but this process can reap it"
        _answer(link, {"id": request_id, "pid": pid, "started": node.started_ticks})
        os._exit(0)
    return lambda: become(spec)


def _answer(link: socket.socket, answer: dict[str, Any]) -> None:
    # If the supervisor is gone nobody waits for the answer, and the next read shows it.
    with contextlib.suppress(OSError):
        link.send(json.dumps(answer).encode())


def serve(link: socket.socket, supervisor: int, packages: Iterable[str], *, cold: bool) -> None:
    """Serve; when the socket is closed, end what is left. In a forked node, run the node.

    `packages`: those whose shared modules the nodes will need, as far as is known.
    """
    # Not inherited: the supervisor ends this process, a signal from a terminal does not.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    # Nodes inherit this: a node that has to end at once must not find the signal ignored.
    signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
    server = SpawnServer(link, supervisor, Preload(packages, cold=cold))
    task = server.serve()
    if task is not None:
        task()
    else:
        run_id, groups = os.environ[RUN_MARK], frozenset(server.groups)
        end_all(lambda: survivors(run_id, groups))


def survivors(run_id: str, groups: frozenset[int]) -> list[Process]:
    """Return the remaining processes of a run, without this one."""
    return [
        process
        for process in processes()
        if process.pid != os.getpid()
        and not process.zombie
        and (process.group in groups or (read_marks(process.pid) or {}).get(RUN_MARK) == run_id)
    ]


def main() -> None:
    """Serve on the socket given in the arguments."""
    link = socket.socket(fileno=int(sys.argv[1]))
    link.set_inheritable(False)
    serve(link, int(sys.argv[2]), (), cold=sys.argv[3] == "cold")


if __name__ == "__main__":
    main()
