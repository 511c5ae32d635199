"""Starting the spawn server: kept apart and light, because the supervisor does it first thing."""

from __future__ import annotations

import os
import signal
import socket
import sys
from dataclasses import dataclass

from launcher.process_marks import NODE_ROOM, TITLE_ROOM
from launcher.process_table import NODE_MARK, RUN_MARK


@dataclass(frozen=True)
class SpawnServerHandle:
    """A spawn server that runs."""

    link: socket.socket
    pid: int
    warm: bool


def start_spawn_server(run_id: str, *, warm: bool) -> SpawnServerHandle:
    """Start one in a session of its own; the calling process is the supervisor of its nodes."""
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    theirs.set_inheritable(True)
    mode = "warm" if warm else "cold"
    argv = [sys.executable, "-m", "launcher.spawn_server", str(theirs.fileno()), str(os.getpid())]
    argv += [mode, "-" * TITLE_ROOM]
    environ = {**os.environ, RUN_MARK: run_id, NODE_MARK: "-" * NODE_ROOM}
    pid = os.posix_spawn(
        sys.executable,
        argv,
        environ,
        file_actions=[(os.POSIX_SPAWN_OPEN, 0, os.devnull, os.O_RDONLY, 0)],
        setsid=True,
        setsigmask=(),
        setsigdef=(signal.SIGCHLD, signal.SIGPIPE),
    )
    theirs.close()
    ours.setblocking(False)
    return SpawnServerHandle(ours, pid, warm)
