"""Starting the observer's process, and ending it."""

from __future__ import annotations

import atexit
import contextlib
import os
import select
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING

from graph.observer.process import language
from graph.observer.process.plain import packed, unpacked
from graph.observer.process.wire import Wire

if TYPE_CHECKING:
    from typing import Any

PROGRAM = Path(__file__).with_name("program.py")
_READ_BYTES = 1 << 16
_ahead: list[ObserverProcess] = []


class ObserverProcess:
    """One that was started here. It dies with the thread that has started it."""

    def __init__(self) -> None:
        """Start it; it imports rclpy, and waits. Raises OSError if that is impossible."""
        ours, theirs = socket.socketpair()
        with theirs, contextlib.ExitStack() as opening:
            self._streams: dict[int, int] = {}
            """What it prints, by a descriptor here, goes to which."""
            ends = []
            for number in (1, 2):
                reading, writing = os.pipe2(os.O_CLOEXEC | os.O_NONBLOCK)
                opening.callback(os.close, writing)
                self._streams[reading] = number
                ends.append(writing)
            self._process = subprocess.Popen(
                [sys.executable, str(PROGRAM), str(theirs.fileno()), str(os.getpid())],
                stdin=subprocess.DEVNULL,
                stdout=ends[0],
                stderr=ends[1],
                pass_fds=(theirs.fileno(),),
                start_new_session=True,
            )
        self.wire = Wire(ours)
        self.send((0, language.PATH, tuple(sys.path), 0.0))

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def is_alive(self) -> bool:
        return self._process.poll() is None

    @property
    def is_ready_to_run(self) -> bool:
        """Whether it only waits for a processor, or for the disk: it does not hang."""
        with contextlib.suppress(OSError):
            stat = Path(f"/proc/{self.pid}/stat").read_text(errors="replace")
            return stat.rpartition(")")[2].split()[0] in "RD"
        return False

    def send(self, order: language.Order) -> None:
        """Send an order; raises PlainError. Whoever reads finds out that nobody is there."""
        pieces = packed(order)
        with contextlib.suppress(OSError):
            self.wire.send(pieces)

    def flush(self) -> None:
        """Send what had no room so far."""
        with contextlib.suppress(OSError):
            self.wire.flush()

    def receive(self) -> list[Any]:
        """Return what it has said since; raises EOFError if it has ended, and PlainError."""
        try:
            return [unpacked(packet) for packet in self.wire.receive()]
        except OSError as error:
            raise EOFError from error

    def wait(self, wake: int, within_s: float) -> None:
        """Wait until it has said something, or there is room for more, or `wake` is readable."""
        waiting = select.poll()
        wanted = select.POLLIN | (select.POLLOUT if self.wire.is_behind else 0)
        waiting.register(self.wire.fileno(), wanted)
        for descriptor in (wake, *self._streams):
            waiting.register(descriptor, select.POLLIN)
        for descriptor, _ in waiting.poll(within_s * 1000.0):
            if descriptor in self._streams:
                self._pass_on(descriptor)

    def end(self, within_s: float) -> None:
        """Wait for its end, so long at most, and kill it then."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(within_s)
        self.kill()

    def kill(self) -> None:
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGKILL)
            self._process.wait()
        self.wire.close()
        for descriptor in tuple(self._streams):
            self._pass_on(descriptor)
        for descriptor in tuple(self._streams):
            self._forget(descriptor)

    def _pass_on(self, descriptor: int) -> None:
        """Print what it has printed: where that goes may have changed since it was started."""
        try:
            printed = os.read(descriptor, _READ_BYTES)
        except BlockingIOError:
            return
        if not printed:
            self._forget(descriptor)
            return
        with contextlib.suppress(OSError):
            os.write(self._streams[descriptor], printed)

    def _forget(self, descriptor: int) -> None:
        del self._streams[descriptor]
        os.close(descriptor)


def start_ahead() -> None:
    """Start one for the next observer, by the main thread, which lives as long as this process."""
    if threading.current_thread() is not threading.main_thread():
        return
    if not _ahead:
        with contextlib.suppress(OSError):
            _ahead.append(ObserverProcess())
            atexit.register(give_up_ahead)


def take_ahead() -> ObserverProcess | None:
    """Return the one that was started ahead, if there is one at work."""
    with contextlib.suppress(IndexError):
        process = _ahead.pop()
        if process.is_alive:
            return process
        process.kill()
    return None


def give_up_ahead() -> None:
    """End the one that was started ahead, if nobody has taken it."""
    process = take_ahead()
    if process is not None:
        process.kill()
