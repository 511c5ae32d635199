"""Simulates faults of a device by changing the bytes to and from it."""

from __future__ import annotations

import random
from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from nodes.simulated.pseudo_terminal import PseudoSerial

FINE, UNPLUGGED, SILENT, NOISE, SLOW = "fine", "unplugged", "silent", "noise", "slow"
FAULTS = (FINE, UNPLUGGED, SILENT, NOISE, SLOW)
SLOW_S = 0.2
"""How long a slow device delays its output."""
_NOISY = 0.02
"""Share of bytes that noise changes."""


class FaultyLine:
    """A device's line, with one of `FAULTS`."""

    def __init__(self, serial: PseudoSerial, seed: int) -> None:
        self._serial, self._dice = serial, random.Random(seed)
        self._fault = FINE
        self._late: deque[tuple[float, bytes]] = deque()

    def set_fault(self, fault: str) -> None:
        """Switch to one of `FAULTS`; raises OSError if it cannot be plugged in again."""
        self._fault = fault
        if fault == UNPLUGGED:
            self._serial.unplug()
        else:
            self._serial.plug()

    def close(self) -> None:
        self._serial.unplug()

    def read(self) -> bytes:
        """Return the bytes that have come for the device."""
        return self._spoil(self._serial.read())

    def write(self, data: bytes, now_s: float) -> None:
        """Send the device's output; `now_s` must never decrease."""
        if self._fault == SILENT:
            self._late.clear()
            return
        if data:
            self._late.append((now_s + (SLOW_S if self._fault == SLOW else 0.0), self._spoil(data)))
        while self._late and (self._late[0][0] <= now_s or self._fault != SLOW):
            self._serial.write(self._late.popleft()[1])

    def _spoil(self, data: bytes) -> bytes:
        if self._fault != NOISE:
            return data
        dice = self._dice
        return bytes(dice.randrange(256) if dice.random() < _NOISY else octet for octet in data) + dice.randbytes(
            dice.randrange(4)
        )
