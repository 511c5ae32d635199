"""Simulated serial devices, and their faults."""

from __future__ import annotations

import contextlib
import os
import pty
import random
import tty
from collections import deque
from pathlib import Path

_MOST = 4096
_TERMINALS = "/dev/pts/"


class PseudoSerial:
    """One device; plugged in from the start. Reads and writes never wait."""

    def __init__(self, path: Path) -> None:
        """`path` becomes a symbolic link; raises OSError if it cannot, or is something else."""
        self.path = path
        self._ends: tuple[int, int] | None = None
        self.plug()

    def plug(self) -> None:
        if self._ends is not None:
            return
        ours, theirs = pty.openpty()
        tty.setraw(theirs)
        os.set_blocking(ours, False)
        # Keeping the other end open avoids an error whenever a program closes it.
        self._ends = ours, theirs
        fresh = self.path.with_name(f".{self.path.name}.{os.getpid()}")
        for path in (self.path, fresh):
            if not _is_free(path):
                self.unplug()
                raise FileExistsError(f"{path} is there already, and no device of ours")
        try:
            fresh.unlink(missing_ok=True)
            fresh.symlink_to(os.ttyname(theirs))
        except OSError:
            self.unplug()
            raise
        fresh.replace(self.path)

    def unplug(self) -> None:
        """Remove the device, as if the cable was pulled."""
        if self._ends is None:
            return
        ours, theirs = self._ends
        self._ends = None
        with contextlib.suppress(OSError):
            if self.path.is_symlink() and str(self.path.readlink()) == os.ttyname(theirs):
                self.path.unlink()
        os.close(theirs)
        os.close(ours)

    def read(self) -> bytes:
        """Return the bytes that have come, usually none."""
        if self._ends is None:
            return b""
        try:
            return os.read(self._ends[0], _MOST)
        except OSError:
            return b""

    def write(self, data: bytes) -> None:
        """Send; bytes that nobody reads for long are lost, as on a real wire."""
        if self._ends is not None and data:
            with contextlib.suppress(OSError):
                os.write(self._ends[0], data)


def _is_free(path: Path) -> bool:
    """Whether nothing has this name, or only the link of a pseudo-terminal."""
    try:
        return str(path.readlink()).startswith(_TERMINALS)
    except FileNotFoundError:
        return True
    except OSError:
        return False


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
