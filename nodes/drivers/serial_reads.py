"""Reading an open port: one wait and one read for whatever has come.

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
"""So long a read may wait before the thread looks whether it shall end."""
_CHUNK = 4096
_STALE_S = 0.5
"""Who has not read for longer throws away what has waited: it is of the past."""


class SerialReads:
    """Reads one port from the time it is opened until it is closed."""

    def __init__(self, port: serial.Serial) -> None:
        self._port, self._handle = port, port.fileno()
        self._poll = select.poll()
        self._poll.register(self._handle, select.POLLIN)
        self._read_s = time.monotonic()

    def read(self) -> bytes:
        """What has come, nothing if that lasts too long; raises OSError if the port is gone."""
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
