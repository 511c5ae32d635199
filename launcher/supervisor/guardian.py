"""The guardian: the supervisor's parent, which outlives it and ends everything it left running.

The supervisor adopts processes that its nodes have started and abandoned. When it is killed, the
kernel gives them to its nearest ancestor that is a subreaper: this process. So none escapes, not
even a daemon in its own session and without our variables in its environment.
"""

from __future__ import annotations

import os
import signal
from typing import NoReturn

from launcher.processes.prctl import become_subreaper, set_short_name, show_title
from launcher.processes.signal import end_all
from launcher.processes.table import GUARDIAN_NAME, Process, processes


def fork_under_guardian() -> None:
    """Fork: this process becomes the guardian; the child, the future supervisor, returns."""
    become_subreaper()
    supervisor = os.fork()
    if supervisor == 0:
        os.setsid()
        return
    _guard(supervisor)


def _guard(supervisor: int) -> NoReturn:
    # Signals to all processes of a service or terminal are for the supervisor to act on.
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    show_title("deck: guardian")
    set_short_name(GUARDIAN_NAME)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for fd in range(3):
        # A reader that waits for the end of the supervisor's output must not wait for us.
        os.dup2(nowhere, fd)
    os.chdir("/")
    while os.wait()[0] != supervisor:
        pass
    end_all(_descendants)
    os._exit(0)


def _descendants() -> list[Process]:
    _reap()
    children: dict[int, list[Process]] = {}
    for process in processes():
        children.setdefault(process.parent, []).append(process)
    found, wanted = [], [os.getpid()]
    while wanted:
        below = children.pop(wanted.pop(), [])
        found += [process for process in below if not process.zombie]
        wanted += [process.pid for process in below]
    return found


def _reap() -> None:
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        return
