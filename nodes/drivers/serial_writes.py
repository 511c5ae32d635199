"""Writes to an open port, and never half of something: what a full port has cut is finished first.

pyserial's own `write` does not say how much it has sent before its time-out. What comes next would
stick to half a line, and the device would refuse both.
"""

from __future__ import annotations

import contextlib
import os
import select
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import serial

_WITHIN_S = 0.1
"""How long a write may wait for room."""


class SerialWrites:
    """Writes to one port from opening until closing."""

    def __init__(self, port: serial.Serial) -> None:
        self._port = port
        self._rest = b""
        """The end of what was begun."""

    def write(self, data: bytes) -> bool:
        """Send; return False if none of it was, since the port takes nothing.

        Of what is begun the rest is sent before anything else. Raises an error of pyserial or
        OSError if the port is gone.
        """
        deadline_s = time.monotonic() + _WITHIN_S
        self._rest = self._sent(self._rest, deadline_s)
        if self._rest:
            return False
        rest = self._sent(data, deadline_s)
        if rest == data:
            return False
        self._rest = rest
        return True

    def _sent(self, data: bytes, deadline_s: float) -> bytes:
        """Send until the deadline; return what is left of it."""
        handle = self._port.fileno()
        room = select.poll()
        room.register(handle, select.POLLOUT)
        while data and (left_s := deadline_s - time.monotonic()) > 0.0:
            if room.poll(left_s * 1e3):
                with contextlib.suppress(BlockingIOError):
                    data = data[os.write(handle, data) :]
        return data
