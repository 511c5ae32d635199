"""Sending a signal to exactly one process, never to another that has reused its pid; ending all that are left."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Protocol

from launcher.processes.table import Process, read_process

_NO_PIDFD = (errno.ENOSYS, errno.EPERM)
"""Errors of a kernel before 5.3, or of a container that does not allow the call."""


KILLED_AFTER_S = 0.7
"""From SIGINT to SIGKILL: together with the search, less than the promised 2 s."""
LEFT_AFTER_S = 10.0
"""After this time a process that SIGKILL does not end is left to the kernel."""
LOOK_EVERY_S = 0.05


class Identified(Protocol):
    """A process, identified by its pid and its start time."""

    @property
    def pid(self) -> int:
        """Its process number."""

    @property
    def started_ticks(self) -> int:
        """Its start time in ticks, see `launcher.processes.table`."""


def lives(process: Identified) -> bool:
    """Whether exactly this process still exists, perhaps as a zombie."""
    found = read_process(process.pid)
    return found is not None and found.started_ticks == process.started_ticks


def send(process: Identified, *numbers: signal.Signals) -> None:
    """Send signals to a process; does nothing if it is gone or belongs to another user."""
    with contextlib.suppress(ProcessLookupError, PermissionError), _held(process.pid) as descriptor:
        # Checked while the process is held open: the number cannot be reused before the signal is
        # sent.
        if not lives(process):
            return
        for number in numbers:
            if descriptor is None:
                os.kill(process.pid, number)
            else:
                signal.pidfd_send_signal(descriptor, number)


@contextlib.contextmanager
def _held(pid: int) -> Iterator[int | None]:
    """Hold a process open by a pidfd; yields None where the kernel has none."""
    try:
        descriptor = os.pidfd_open(pid)
    except OSError as problem:
        if problem.errno not in _NO_PIDFD:
            raise
        yield None
        return
    try:
        yield descriptor
    finally:
        os.close(descriptor)


def end_all(find: Callable[[], Sequence[Process]]) -> None:
    """End all processes that `find` returns, looking again until it returns none."""
    began_s = time.monotonic()
    told: set[int] = set()
    while left := find():
        elapsed_s = time.monotonic() - began_s
        if elapsed_s > LEFT_AFTER_S:
            return
        for process in left:
            if elapsed_s >= KILLED_AFTER_S:
                send(process, signal.SIGKILL)
            elif process.pid not in told:
                send(process, signal.SIGINT, signal.SIGCONT)
        told.update(process.pid for process in left)
        time.sleep(LOOK_EVERY_S)
