"""Reads an open port: one wait and one read for whatever has come.

pyserial's own `read` waits and reads once for the first byte and once more for the rest.
"""

from __future__ import annotations

import errno
import os
import select
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import serial

_WAIT_MS = 100
"""How long a read may wait before the thread checks whether it should end."""
_CHUNK = 4096
_STALE_S = 0.5
"""After a longer pause the waiting bytes are discarded as outdated."""


class SerialReads:
    """Reads one port from opening until closing."""

    def __init__(self, port: serial.Serial) -> None:
        self._port, self._handle = port, port.fileno()
        self._poll = select.poll()
        self._poll.register(self._handle, select.POLLIN)
        self._read_s = time.monotonic()

    def read(self) -> bytes:
        """Return what has come, nothing after a time-out; raises OSError if the port is gone."""
        before_s, ready = self._read_s, self._poll.poll(_WAIT_MS)
        self._read_s = time.monotonic()
        if self._read_s - before_s > _STALE_S:
            self._port.reset_input_buffer()
            return b""
        if not ready:
            return b""
        try:
            data = os.read(self._handle, _CHUNK)
        except BlockingIOError:
            return b""
        if not data:
            raise OSError(errno.EIO, os.strerror(errno.EIO))
        return data
