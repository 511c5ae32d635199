"""A port opened for a check: bytes in and out, each with a deadline."""

from __future__ import annotations

import contextlib
import termios
import time
from typing import TYPE_CHECKING

import serial

if TYPE_CHECKING:
    from collections.abc import Callable

BAD = (OSError, termios.error, serial.SerialException, TypeError)
"""The exceptions that pyserial raises when a cable is unplugged."""
_READ_S, _WRITE_S = 0.05, 0.3
_MOST = 4096


class OpenPort:
    """An open port; must be closed."""

    def __init__(self, path: str, baud: int) -> None:
        """Open it exclusively.

        Raises:
            OSError, ValueError: if that is not possible.
        """
        self.baud = baud
        self._port = serial.Serial(path, baud, timeout=_READ_S, write_timeout=_WRITE_S, exclusive=True)

    def close(self) -> None:
        with contextlib.suppress(*BAD):
            self._port.close()

    def hear(self, seconds: float, enough: Callable[[bytes], bool]) -> bytes:
        """Return the data of so many seconds; sooner if `enough` is true for a piece of it.

        Raises:
            OSError: if the device disappears.
        """
        end_s, heard = time.monotonic() + seconds, b""
        try:
            while time.monotonic() < end_s:
                data = self._port.read(1)
                data += self._port.read(min(self._port.in_waiting, _MOST))
                heard += data
                if data and enough(data):
                    break
        except (termios.error, TypeError) as error:
            raise OSError(str(error)) from error
        return heard

    def say(self, data: bytes) -> None:
        """Send data, whether or not it is received.

        Raises:
            OSError: if the device disappears.
        """
        try:
            with contextlib.suppress(serial.SerialTimeoutException):
                self._port.write(data)
        except (termios.error, TypeError) as error:
            raise OSError(str(error)) from error
