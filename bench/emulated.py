"""Emulated devices of the robot, on pseudo-terminals; every line is recorded with its time.

Times are `time.monotonic()`, taken right after a read and right before a write.
"""

from __future__ import annotations

import contextlib
import os
import pty
import select
import threading
import time
import tty
from typing import TYPE_CHECKING

from robot.wire.pico import Drive, Halt, PicoDecoder, Release
from robot.wire.tfluna import TofFrame
from robot.wire.tfluna import encode as encode_tof
from robot.world.pico import SimulatedPico
from robot.world.world import STEP_S, World

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from typing_extensions import Self

    from robot.wire.pico import Message

FAR_M, NEAR_M = 3.0, 0.3


class Line:
    """A serial line under a permanent name."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lock = threading.Lock()
        self._ends: tuple[int, int] | None = None
        self.plug()

    def plug(self) -> None:
        ours, theirs = pty.openpty()
        tty.setraw(theirs)
        os.set_blocking(ours, False)
        with self._lock:
            self._ends = ours, theirs
            self.path.symlink_to(os.ttyname(theirs))

    def unplug(self) -> None:
        """Disconnect the device, as if the cable was unplugged."""
        with self._lock:
            if self._ends is not None:
                self.path.unlink()
                for end in self._ends:
                    os.close(end)
                self._ends = None

    def wait(self, seconds: float) -> None:
        """Wait until data has arrived, at most this long."""
        ends = self._ends
        if ends is None:
            time.sleep(seconds)
        else:
            with contextlib.suppress(OSError, ValueError):
                select.select([ends[0]], [], [], max(0.0, seconds))

    def read(self) -> bytes:
        """Return the data that has arrived, usually nothing."""
        with self._lock, contextlib.suppress(OSError):
            return os.read(self._ends[0], 4096) if self._ends else b""
        return b""

    def write(self, data: bytes) -> None:
        """Send data; if it is not read for long, it is lost."""
        with self._lock, contextlib.suppress(OSError):
            if self._ends and data:
                os.write(self._ends[0], data)


class Device:
    """A device on its own thread; use it in a `with` statement."""

    def __init__(self, path: Path) -> None:
        self.line = Line(path)
        self._ending = False
        self._thread = threading.Thread(target=self._live, name=path.name, daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ending = True
        self._thread.join()
        self.line.unplug()

    def _live(self) -> None:
        due_s = time.monotonic()
        while not self._ending:
            due_s += STEP_S
            while (left_s := due_s - time.monotonic()) > 0:
                self._wait(left_s)
            self._step()

    def _wait(self, seconds: float) -> None:
        time.sleep(seconds)

    def _step(self) -> None:
        raise NotImplementedError


class Pico(Device):
    """The simulated Pico; records every line that it receives."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.heard: list[tuple[float, Message]] = []
        """The time and the message of each line."""
        self._pico = SimulatedPico(World())
        self._decoder = PicoDecoder()

    def driven(self, since_s: float) -> float | None:
        """Return the time of the first command after this to turn the wheels, None if none came."""
        return self._first(since_s, lambda line: isinstance(line, Drive) and line.left_rad_s != 0)

    def stopped(self, since_s: float) -> float | None:
        """Return the time of the first command after this to stop the wheels."""
        return self._first(since_s, lambda line: isinstance(line, Drive) and line.left_rad_s == 0)

    def halted(self, since_s: float) -> float | None:
        """Return the time of the first emergency stop after this."""
        return self._first(since_s, lambda line: isinstance(line, Halt))

    def released(self, since_s: float) -> float | None:
        """Return the time of the first release of the emergency stop after this."""
        return self._first(since_s, lambda line: isinstance(line, Release))

    def _first(self, since_s: float, fits: Callable[[Message], bool]) -> float | None:
        found = None
        for at_s, line in reversed(self.heard):
            if at_s < since_s:
                break
            found = at_s if fits(line) else found
        return found

    def _wait(self, seconds: float) -> None:
        self.line.wait(seconds)
        data = self.line.read()
        if data:
            now_s = time.monotonic()
            self.heard += [(now_s, line) for line in self._decoder.feed(data)]
            self._pico.feed(data)

    def _step(self) -> None:
        self.line.write(self._pico.step())
        self._pico.world.step()


class Sonar(Device):
    """A TF-Luna that measures `metres`, 100 times a second."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self.metres = FAR_M
        self.told_s: dict[float, float] = {}
        """When each distance was first sent since this was cleared."""

    def _step(self) -> None:
        metres = self.metres
        frame = encode_tof(TofFrame(round(100 * metres), 1000, 25.0))
        self.told_s.setdefault(metres, time.monotonic())
        self.line.write(frame)
