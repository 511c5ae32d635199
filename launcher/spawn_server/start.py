"""Starting the spawn server: separate and light, because the supervisor does it first."""

from __future__ import annotations

import os
import signal
import socket
import sys
from dataclasses import dataclass

from launcher.processes.prctl import ROOM_ARGUMENT, room_for_marks, show_mark, show_title
from launcher.processes.table import RUN_MARK, read_process


@dataclass(frozen=True)
class SpawnServerHandle:
    """A running spawn server."""

    link: socket.socket
    pid: int
    started_ticks: int
    warm: bool


def fork_spawn_server(run_id: str) -> SpawnServerHandle:
    """Fork a warm server from this process, which becomes the parent of its nodes.

    This is faster than starting another Python, and only possible while this one has done nothing
    else. In the server, and in everything forked from it, this function does not return.
    """
    supervisor = os.getpid()
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    pid = os.fork()
    if pid:
        theirs.close()
        return _handle(ours, pid, warm=True)
    ours.close()
    os.setsid()
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
    os.environ[RUN_MARK] = run_id
    show_mark(RUN_MARK, run_id)
    show_title("deck: spawn server")

    from launcher.spawn_server.server import serve

    serve(theirs, supervisor, cold=False)
    sys.exit()


def start_spawn_server(run_id: str, *, warm: bool) -> SpawnServerHandle:
    """Start one as a program, in its own session; this process is its nodes' supervisor."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    theirs.set_inheritable(True)
    mode = "warm" if warm else "cold"
    argv = [sys.executable, "-m", "launcher.spawn_server.server", str(theirs.fileno()), str(os.getpid())]
    pid = os.posix_spawn(
        sys.executable,
        [*argv, mode, ROOM_ARGUMENT],
        {**os.environ, **room_for_marks(), RUN_MARK: run_id},
        file_actions=[(os.POSIX_SPAWN_OPEN, 0, os.devnull, os.O_RDONLY, 0), (os.POSIX_SPAWN_DUP2, 2, 1)],
        setsid=True,
        setsigmask=(),
        setsigdef=(signal.SIGCHLD, signal.SIGPIPE),
    )
    theirs.close()
    return _handle(ours, pid, warm=warm)


def _handle(link: socket.socket, pid: int, *, warm: bool) -> SpawnServerHandle:
    link.setblocking(False)
    process = read_process(pid)
    assert process is not None, "a child of ours that nobody has reaped"
    return SpawnServerHandle(link, pid, process.started_ticks, warm)
