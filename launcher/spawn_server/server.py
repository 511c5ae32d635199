"""The spawn server: a child of the supervisor from which all nodes are forked.

The first one is forked from the supervisor before that has imported anything; later ones are
started as `python -m launcher.spawn_server.server FD PID MODE ROOM`: FD is its end of a seqpacket
socket, PID the supervisor, MODE `warm` or `cold`, and ROOM a filler that makes room for titles
(`launcher.processes.prctl`).

A request is one packet of descriptors: first that of a memory file with a JSON object, then the new
process's stdin (optional), stdout and stderr. The answer is a packet of JSON,
`{"id": ..., "pid": ..., "started": ...}` with the start in ticks, or `{"id": ..., "error": ...}`. A
node is forked by an intermediate process that exits, so that it becomes a child of the supervisor.

When the socket is closed the supervisor is gone, and this process, which outlives it, ends
everything it has left running: the nodes died with the supervisor (PDEATHSIG), but their children did not.
"""

from __future__ import annotations

import contextlib
import json
import os
import select
import signal
import socket
import sys
from collections.abc import Callable
from typing import Any

from launcher.processes.members import is_marked
from launcher.processes.signal import end_all
from launcher.processes.table import RUN_MARK, Process, processes, read_process
from launcher.spawn_server import SpawnRequest
from launcher.spawn_server.node import ENDING, become
from launcher.spawn_server.preload import Preload
from launcher.wire import unpack
from text.nested import read_json

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
        self._waiting: list[tuple[int, SpawnRequest, list[int]]] = []

    def serve(self) -> Callable[[], None] | None:
        """Serve until the socket is closed.

        Returns:
            None at the end; in a forked process, the function it has to run next.
        """
        while True:
            task = None
            if self._preload.done and self._waiting:
                task = self._fork(*self._waiting.pop(0))
            elif self._request_is_there():
                packet, fds, _flags, _address = socket.recv_fds(self._link, 1, MAX_FDS)
                if not packet:
                    return None
                number, request = _read(fds.pop(0))
                if request.kind == "exec" or self._preload.done:
                    task = self._fork(number, request, fds)
                else:
                    self._waiting.append((number, request, fds))
            else:
                self._preload.step()
            if task is not None:
                return task

    def _request_is_there(self) -> bool:
        """Wait for a request, but not while there are imports left."""
        timeout = self._preload.wait_s
        if self._intermediates:
            self._collect()
            timeout = COLLECT_EVERY_S if timeout is None else timeout
        return bool(select.select([self._link], [], [], timeout)[0])

    def _fork(self, number: int, request: SpawnRequest, fds: list[int]) -> Callable[[], None] | None:
        """Fork a process that forks the node, so that the server can go on with the next request."""
        try:
            pid = os.fork()
        except OSError as problem:
            self._answer({"id": number, "error": problem.strerror})
        else:
            if pid == 0:
                self._fork_on(number)
                return lambda: become(request, fds, self._supervisor, self._preload)
            self._intermediates.add(pid)
        for fd in fds:
            os.close(fd)
        return None

    def _fork_on(self, number: int) -> None:
        """Fork the node, answer the request, and exit; only the node returns from this function."""
        try:
            pid = os.fork()
        except OSError as problem:
            self._answer({"id": number, "error": problem.strerror})
            os._exit(1)
        if pid:
            node = read_process(pid)
            assert node is not None, "nobody but this process can reap it"
            self._answer({"id": number, "pid": pid, "started": node.started_ticks})
            os._exit(0)

    def _collect(self) -> None:
        for pid in tuple(self._intermediates):
            if os.waitpid(pid, os.WNOHANG)[0] == pid:
                self._intermediates.remove(pid)

    def _answer(self, answer: dict[str, Any]) -> None:
        # If the supervisor is gone nobody waits for the answer, and the next read shows it.
        with contextlib.suppress(OSError):
            self._link.send(json.dumps(answer).encode())


def _read(fd: int) -> tuple[int, SpawnRequest]:
    with open(fd, "rb") as file:
        file.seek(0)
        message = read_json(file.read())
    return message["id"], unpack(SpawnRequest, message)


def serve(link: socket.socket, supervisor: int, *, cold: bool) -> None:
    """Serve; when the socket is closed, end what is left. In a forked node, run the node."""
    # Not inherited: the supervisor ends this process, a signal from a terminal does not.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    # Nodes inherit this: a node that has to end at once must not find the signal ignored.
    signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
    task = SpawnServer(link, supervisor, Preload(cold=cold)).serve()
    if task is not None:
        task()
    else:
        end_all(_survivors)


def _survivors() -> list[Process]:
    """Return the remaining processes of the run, without this one."""
    run_id, us = os.environ[RUN_MARK], os.getpid()
    return [each for each in processes() if each.pid != us and not each.zombie and is_marked(each, run_id)]


def main() -> None:
    """Serve on the socket given in the arguments."""
    link = socket.socket(fileno=int(sys.argv[1]))
    link.set_inheritable(False)
    serve(link, int(sys.argv[2]), cold=sys.argv[3] == "cold")


if __name__ == "__main__":
    main()
