"""Emulated servos on a pseudo-terminal, to be looked at from within the test."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

from nodes.simulated.device_fault import FINE, FaultyLine
from nodes.simulated.pseudo_terminal import PseudoSerial
from robot.world.servos import SimulatedServos

if TYPE_CHECKING:
    from pathlib import Path

_STEP_S = 0.005


class ServoBench:
    """An LSC-16 that keeps time with the clock; to be closed."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.servos = SimulatedServos()
        self.taken = b""
        """All that came for the device."""
        self.says = b""
        """What it says all the time in place of an answer, if anything."""
        self._lock = threading.Lock()
        self._line = FaultyLine(PseudoSerial(path), seed=1)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._live, name="servos", daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._ending.set()
        self._thread.join(5)
        self._line.close()

    def fail(self, fault: str = FINE) -> None:
        """Have one of the faults of the mock robot from now on."""
        with self._lock:
            self._line.set_fault(fault)

    def at(self, servo: int) -> float:
        """Pulse of a servo now, us."""
        with self._lock:
            return self.servos.pulse_us(servo)

    def _live(self) -> None:
        last_s = time.monotonic()
        while not self._ending.wait(_STEP_S):
            now_s = time.monotonic()
            with self._lock:
                heard = self._line.read()
                self.taken += heard
                self.servos.advance(now_s - last_s)
                answer = self.servos.feed(heard)
                self._line.write(self.says or answer, now_s)
            last_s = now_s
