"""The spawn server: a child of the supervisor from which every node is forked.

`python -m launcher.spawn_server FD PID MODE ROOM`: FD is its end of a seqpacket socket, PID the
supervisor, MODE `warm` or `cold`, and ROOM mere length for titles (`launcher.process_marks`).

One request is one JSON packet with the file descriptors of the new process's stdin (optional),
stdout and stderr; the answer is `{"id": ..., "pid": ...}` or `{"id": ..., "error": ...}`. A node
is forked through an intermediate that exits, so that it becomes the supervisor's own child.

At the end of the socket the supervisor is gone, and this process, which outlives it, ends
whatever it has left running (`launcher.spawn_server_undertaker`).
"""

from __future__ import annotations

import json
import os
import select
import signal
import socket
import sys
from typing import TYPE_CHECKING, Any

from launcher.process_table import RUN_MARK
from launcher.spawn_server_node import Birth, become
from launcher.spawn_server_undertaker import undertake
from launcher.spawn_server_warm import Preload

if TYPE_CHECKING:
    from collections.abc import Callable

MAX_REQUEST = 1 << 20
MAX_FDS = 3


class SpawnServer:
    """Answers the supervisor's requests until the supervisor has gone."""

    def __init__(self, link: socket.socket, supervisor: int, preload: Preload) -> None:
        """`preload`: what is still to be imported before warm nodes can be forked."""
        self._link = link
        self._supervisor = supervisor
        self._preload = preload
        self._waiting: list[tuple[dict[str, Any], list[int]]] = []
        self.groups: set[int] = set()

    def serve(self) -> Callable[[], None] | None:
        """Serve to the end of the socket.

        Returns:
            None at the end; in a process that was forked here, what it has to do now.
        """
        while True:
            if self._preload.done and self._waiting:
                task = self._fork(*self._waiting.pop(0))
            elif self._request_is_there():
                packet, fds, _flags, _address = socket.recv_fds(self._link, MAX_REQUEST, MAX_FDS)
                if not packet:
                    return None
                task = self._take(json.loads(packet), fds)
            else:
                self._preload.step()
                continue
            if task is not None:
                return task

    def _request_is_there(self) -> bool:
        """Wait for a request, but do not wait while there is something to be imported."""
        timeout = 0.0 if not self._preload.done else None
        return bool(select.select([self._link], [], [], timeout)[0])

    def _take(self, request: dict[str, Any], fds: list[int]) -> Callable[[], None] | None:
        if request["kind"] == "adopt":
            self.groups.update(request["groups"])
            return None
        if request["kind"] == "dismiss":
            os._exit(0)
        if request["kind"] == "forget":
            self.groups.difference_update(request["groups"])
            return None
        if request["kind"] != "exec" and not self._preload.done:
            self._waiting.append((request, fds))
            return None
        return self._fork(request, fds)

    def _fork(self, request: dict[str, Any], fds: list[int]) -> Callable[[], None] | None:
        birth = Birth.from_request(request, fds, self._supervisor, self._preload.broken)
        read, write = os.pipe()
        try:
            pid = os.fork()
        except OSError as problem:
            node, error = 0, str(problem.strerror)
        else:
            if pid == 0:
                return _fork_on(birth, write)
            os.waitpid(pid, 0)
            os.set_blocking(read, False)
            node, error = _reported(read)
        for fd in (read, write, *fds):
            os.close(fd)
        self._answer(request["id"], node, error)
        return None

    def _answer(self, request_id: int, node: int, error: str) -> None:
        if node:
            self.groups.add(node)
        answer = {"id": request_id, "error": error} if error else {"id": request_id, "pid": node}
        try:
            self._link.send(json.dumps(answer).encode())
        except OSError:
            return  # The supervisor has just gone; the next read says so.


def _reported(fd: int) -> tuple[int, str]:
    """Return the number of the node that the intermediate has forked, or why there is none."""
    try:
        return int(os.read(fd, 32)), ""
    except (BlockingIOError, ValueError):
        return 0, "the system refuses another process"


def _fork_on(birth: Birth, report: int) -> Callable[[], None]:
    """Fork the node and exit: what comes after runs in the node alone."""
    try:
        pid = os.fork()
    except OSError:
        os._exit(1)
    if pid:
        os.write(report, str(pid).encode())
        os._exit(0)
    return lambda: become(birth)


def main() -> None:
    """Serve; at the end of the socket be the undertaker; in a forked node be the node."""
    fd, supervisor, mode = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    link = socket.socket(fileno=fd)
    link.set_inheritable(False)
    # Whoever started the supervisor may have had these ignored.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    server = SpawnServer(link, supervisor, Preload(cold=mode == "cold"))
    task = server.serve()
    if task is not None:
        task()
    else:
        undertake(os.environ[RUN_MARK], server.groups)


if __name__ == "__main__":
    main()
