"""The loss of the terminal, noticed on a thread that waits for nothing else.

Whatever the others do, blocked in a write, in a lock or in a computation: soon after the terminal
has gone, this process is gone, too. Its supervisor then ends what it has started.
"""

from __future__ import annotations

import os
import select
import signal
import threading
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

ORDERLY_END_S = 1.6
"""How long an orderly end may take; with what goes before and after it, 2 s."""
EXIT_CODE = 128 + signal.SIGHUP


def hung_up(fd: int, wait_ms: int = 0) -> bool:
    """Return whether the terminal behind this descriptor has gone, within that time."""
    return _hung_up((fd,), wait_ms)


def _hung_up(fds: Iterable[int], wait_ms: int | None) -> bool:
    poll = select.poll()
    for fd in fds:
        # Nothing is asked for: a hang-up is always reported.
        poll.register(fd, 0)
    return bool(poll.poll(wait_ms))


def end_when_gone(
    fds: Iterable[int], gone: Callable[[], object], exit_now: Callable[[int], object] = os._exit
) -> None:
    """Watch a terminal until the process ends; call `gone` on another thread when it has gone."""
    watching = (tuple(fds), gone, exit_now)
    threading.Thread(target=_watch, args=watching, name="hang-up", daemon=True).start()


def _watch(fds: Iterable[int], gone: Callable[[], object], exit_now: Callable[[int], object]) -> None:
    _hung_up(fds, None)
    threading.Thread(target=gone, name="hung-up", daemon=True).start()
    time.sleep(ORDERLY_END_S)
    exit_now(EXIT_CODE)
