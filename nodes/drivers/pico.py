"""The computer's side of the Pico protocol: handshake, drive lines, counts of the replies.

`heard` runs on the reader's thread, everything else on the node's.
"""

from __future__ import annotations

import math
import threading
import time
from typing import TYPE_CHECKING

from nodes.drivers.serial_link import SerialLink
from robot.frames.pico import PicoReader
from robot.wire.pico import (
    PROTOCOL,
    SEQUENCES,
    Drive,
    Halt,
    Hello,
    Message,
    PicoDecoder,
    Release,
    Telemetry,
    Welcome,
    encode,
)
from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Callable

    from nodes.parts.node import LessonNode

_HELLO_EVERY_S = 0.3
SILENT_AFTER_S = 0.5

_WELCOME = N_("The Pico answers: firmware {firmware}, protocol {protocol}")
_OTHER_PROTOCOL = N_("The Pico speaks protocol {theirs}, this program {ours}: the wheels stand; flash firmware/pico2")
_SILENT = N_("{port} is open, but no Pico answers: another device, or no firmware on it?")


class PicoClient:
    """Communicates over a `SerialLink`; `start` and `close` that."""

    def __init__(self, node: LessonNode, baud: int, heard: Callable[[Telemetry], None]) -> None:
        self._say, self._heard = node.say, heard
        self.link = SerialLink(node, baud, self._hear, self._opened, self._forget, PicoReader)
        self._lock = threading.Lock()
        self._decoder = PicoDecoder()
        self._sequence = 0
        self._greeted_s = 0.0
        self._heard_s, self._opened_s = 0.0, math.inf
        self.telemetry: Telemetry | None = None
        """The newest telemetry, None while there is no connection."""
        self.frames = 0
        """Valid lines received."""
        self.lost = 0
        """Lines from the Pico that were lost, by their numbers."""

    @property
    def errors(self) -> int:
        """Lines that were invalid, on either side, or lost."""
        refused = self.telemetry.refused if self.telemetry is not None else 0
        return self._decoder.errors + self.lost + refused

    @property
    def answers(self) -> bool:
        return self.telemetry is not None and time.monotonic() - self._heard_s < SILENT_AFTER_S

    @property
    def silent(self) -> bool:
        """Whether the port is open but nothing valid has come for a while."""
        known_s = max(self._heard_s, self._opened_s)
        return self.link.connected and time.monotonic() - known_s > SILENT_AFTER_S

    def drive(self, left_rad_s: float, right_rad_s: float, steering_rad: float) -> None:
        """Command the wheels; before that, greet the Pico if it does not know us yet."""
        telemetry = self.telemetry
        if not self.answers or (telemetry is not None and "H" in telemetry.flags):
            self._greet_again()
        if telemetry is not None and "A" in telemetry.flags:
            # The firmware requires a stop before it obeys again.
            left_rad_s = right_rad_s = 0.0
        self._send(lambda seq: Drive(seq, left_rad_s, right_rad_s, steering_rad))
        if self.silent:
            self._say.warn(_SILENT, every_s=10.0, port=self.link.port)

    def halt(self) -> None:
        """Latch the emergency stop."""
        self._send(Halt)

    def release(self) -> None:
        self._send(Release)

    def _send(self, build: Callable[[int], Message]) -> None:
        with self._lock:
            line = encode(build(self._sequence))
            if self.link.write(line):
                self._sequence = (self._sequence + 1) % SEQUENCES

    def _greet_again(self) -> None:
        if time.monotonic() - self._greeted_s > _HELLO_EVERY_S:
            self._greet()

    # ---------------------------------------------------------------- the reader's thread

    def _opened(self) -> None:
        self._opened_s = time.monotonic()
        self._greet()

    def _greet(self) -> None:
        self._greeted_s = time.monotonic()
        self._send(Hello)

    def _forget(self) -> None:
        self.telemetry, self._opened_s = None, math.inf

    def _hear(self, data: bytes) -> None:
        for message in self._decoder.feed(data):
            self.frames += 1
            if isinstance(message, Welcome):
                self._welcome(message)
            elif isinstance(message, Telemetry):
                last, self.telemetry = self.telemetry, message
                self._heard_s = time.monotonic()
                if last is not None and last.uptime_ms <= message.uptime_ms:
                    self.lost += max(0, (message.seq - last.seq) % SEQUENCES - 1) % 1000
                self._heard(message)

    def _welcome(self, message: Welcome) -> None:
        if message.protocol == PROTOCOL:
            self._say.info(_WELCOME, every_s=1.0, firmware=message.firmware, protocol=message.protocol)
        else:
            self._say.error(_OTHER_PROTOCOL, every_s=10.0, theirs=message.protocol, ours=PROTOCOL)
