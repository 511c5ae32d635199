"""Reading a node's pipe as soon as there is data, without ever blocking."""

from __future__ import annotations

import asyncio
import contextlib
import fcntl
import os
import time
from collections.abc import Callable

from launcher.logs.lines import IDLE_S, LineAssembler, RawLine

CHUNK = 64 * 1024
PIPE_BYTES = 256 * 1024
"""Pipe capacity: room for what a node writes while the supervisor is busy with another."""
_MAX_DRAIN = 4 << 20


class PipeReader:
    """Reads one pipe to its end."""

    def __init__(self, fd: int, on_bytes: Callable[[bytes], None], on_lines: Callable[[list[RawLine]], None]) -> None:
        """`fd` is closed by this object; `on_bytes` gets all data, in pieces that end lines."""
        self._fd = fd
        self._on_bytes = on_bytes
        self._on_lines = on_lines
        self._assembler = LineAssembler()
        self._held = b""
        self._idle: asyncio.TimerHandle | None = None
        self._loop = asyncio.get_running_loop()
        os.set_blocking(fd, False)
        self._loop.add_reader(fd, self._read)

    def drain(self) -> None:
        """Read what is left in the pipe: its writer has ended."""
        for _chunk in range(_MAX_DRAIN // CHUNK):
            if not self._read():
                return

    def close(self) -> None:
        """Read what is left in the pipe, then stop reading."""
        self.drain()
        self._end()

    def _read(self) -> bool:
        if self._fd < 0:
            return False
        try:
            chunk = os.read(self._fd, CHUNK)
        except BlockingIOError:
            return False
        except OSError:
            chunk = b""
        if not chunk:
            self._end()
            return False
        self._keep(chunk)
        lines = self._assembler.feed(chunk, time.monotonic())
        if lines:
            self._on_lines(lines)
        if self._assembler.unfinished and self._idle is None:
            self._idle = self._loop.call_later(IDLE_S, self._flush)
        return True

    def _keep(self, chunk: bytes) -> None:
        """Pass whole lines to the file: the node's other stream goes to the same file."""
        end = chunk.rfind(b"\n") + 1
        if end or len(self._held) > CHUNK:
            end = end or len(chunk)
            self._on_bytes(self._held + chunk[:end])
            self._held = chunk[end:]
        else:
            self._held += chunk

    def _flush(self) -> None:
        self._idle = None
        lines = self._assembler.flush(time.monotonic())
        if lines:
            self._on_lines(lines)
        if self._assembler.unfinished:
            self._idle = self._loop.call_later(IDLE_S, self._flush)

    def _end(self) -> None:
        if self._fd < 0:
            return
        self._loop.remove_reader(self._fd)
        os.close(self._fd)
        self._fd = -1
        if self._idle is not None:
            self._idle.cancel()
        lines = self._assembler.flush(time.monotonic(), at_end=True)
        if lines:
            self._on_lines(lines)
        if self._held:
            self._on_bytes(self._held + b"\n")
            self._held = b""


def node_pipe() -> tuple[int, int]:
    """Return a pipe for a node's output: our end and the node's end."""
    read, write = os.pipe()
    # The user may have used up the pipe memory that one user is allowed.
    with contextlib.suppress(OSError):
        fcntl.fcntl(write, getattr(fcntl, "F_SETPIPE_SZ", 1031), PIPE_BYTES)
    return read, write
