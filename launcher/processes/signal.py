"""A signal to exactly one process, never to another that has reused its pid."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
from typing import TYPE_CHECKING, Protocol

from launcher.processes.table import read_process

if TYPE_CHECKING:
    from collections.abc import Iterator

_NO_PIDFD = (errno.ENOSYS, errno.EPERM)
"""A kernel before 5.3, or a container that has not heard of the call."""


class Identified(Protocol):
    """A process, identified by its pid and its start time."""

    @property
    def pid(self) -> int:
        """Its number."""

    @property
    def started_ticks(self) -> int:
        """Its start, see `launcher.processes.table`."""


def lives(process: Identified) -> bool:
    """Whether this very process is there, be it as one that waits to be reaped."""
    found = read_process(process.pid)
    return found is not None and found.started_ticks == process.started_ticks


def send(process: Identified, *numbers: signal.Signals) -> None:
    """Send signals to a process; nothing if it has gone, or is somebody else's."""
    with contextlib.suppress(ProcessLookupError, PermissionError), _held(process.pid) as descriptor:
        # Looked at while it is held: whoever has the number now has it until the signal is sent.
        if not lives(process):
            return
        for number in numbers:
            if descriptor is None:
                os.kill(process.pid, number)
            else:
                signal.pidfd_send_signal(descriptor, number)


@contextlib.contextmanager
def _held(pid: int) -> Iterator[int | None]:
    """Open a process, as far as this kernel lets it be held."""
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
