"""The computer's side of the LSC-16: sends moves, and asks for the voltage to see that it is there.

The controller does not answer moves, so only its answer about the voltage distinguishes it from
another device or an unconnected wire.
"""

from __future__ import annotations

import math
import threading
import time

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from nodes.drivers.serial_link import SerialLink
from nodes.parts.node import LessonNode
from robot.frames.readers import ServoReader
from robot.wire.lsc16 import Battery, BatteryRequest, ServoDecoder, ServoMove, encode
from text.i18n import N_

_MISSED = 3
"""This many missing answers count as silence."""
_ANSWER_S = 0.3
"""Maximum time for an answer, with a slow adapter."""
_LOW_EVERY_S = 60.0

_ANSWERS = N_("The servo controller answers: battery {volts:.1f} V")
WAS_AWAY = N_("the controller was away while the head moved")
_NO_CONNECTION = N_("no connection to {port}")
_NOT_YET = N_("the controller at {port} has not answered yet")
_SILENT = N_(
    "{port} is open, but no LSC-16 answers: is it powered, are RX and TX both wired, {baud} baud?"
    " (with TX alone set battery_every_s to 0)"
)
_GARBLED = N_("{port} is open, but its data are not from an LSC-16: wrong port, or not {baud} baud?")
_LOW = N_("The battery of the servos is low: {volts:.1f} V")
_COMMANDED = N_("positions are commanded, not measured")


class ServoClient:
    """Communicates over a `SerialLink`; `start` and `close` that."""

    def __init__(self, node: LessonNode) -> None:
        self._node, self._say = node, node.say
        self._every_s = node.values["battery_every_s"]
        self.link = SerialLink(node, node.values["baud"], self._hear, self._begin, self._forget, ServoReader)
        self._decoder = ServoDecoder()
        self._battery: Battery | None = None
        """The newest voltage of this connection."""
        self._heard_s, self._opened_s = 0.0, math.inf
        self._skipped = 0
        """Invalid bytes, as of the last voltage."""
        self._silence_told = False
        self._away = threading.Event()
        if self._every_s:
            node.every(self._every_s, self._ask)

    def move(self, pulses_us: tuple[tuple[int, int], ...], time_ms: int) -> bool:
        """Move servos to pulses; return False if there is no connection."""
        return self.trouble() is None and self.link.write(encode(ServoMove(time_ms, pulses_us)))

    def trouble(self) -> str | None:
        """Return why a move would not be obeyed now, None if it would."""
        phrase = self._phrase()
        return None if phrase is None else self._told(phrase)

    def was_away(self) -> bool:
        """Return whether the controller is away or silent, or was since the last call."""
        self._look()
        was_away = self._away.is_set() or not self.link.connected
        self._away.clear()
        return was_away

    def status(self, name: str) -> DiagnosticStatus:
        """Return the status for /diagnostics."""
        status = self.link.status(name, self._decoder.skipped, self._decoder.frames)
        status.values.append(KeyValue(key="positions", value="commanded"))
        battery, phrase = self._battery, self._phrase()
        if phrase is not None and self.link.connected:
            status.level = status.WARN if phrase is _NOT_YET else status.ERROR
            status.message = self._told(phrase)
        elif battery is not None:
            volts = battery.millivolts / 1000
            status.values.append(KeyValue(key="battery_v", value=f"{volts:.2f}"))
            status.message += f"; {self._say.text(_COMMANDED)}"
            if volts < self._node.values["battery_low"]:
                status.level, status.message = status.WARN, self._say.text(_LOW, volts=volts)
        return status

    def _phrase(self) -> str | None:
        if not self.link.connected:
            return _NO_CONNECTION
        if not self._every_s:
            return None
        known_s = max(self._heard_s, self._opened_s)
        if time.monotonic() - known_s > _MISSED * self._every_s + _ANSWER_S:
            return _GARBLED if self._decoder.skipped > self._skipped else _SILENT
        return _NOT_YET if self._battery is None else None

    def _told(self, phrase: str) -> str:
        return self._say.text(phrase, port=self.link.port, baud=self.link.baud)

    def _ask(self) -> None:
        self.link.write(encode(BatteryRequest()))
        self._look()

    def _look(self) -> None:
        """Log that the controller is silent, once each time."""
        phrase = self._phrase()
        if phrase not in (_SILENT, _GARBLED):
            self._silence_told = False
            return
        self._away.set()
        if not self._silence_told:
            self._silence_told = True
            self._say.error(phrase, port=self.link.port, baud=self.link.baud)

    # ---------------------------------------------------------------- the reader's thread

    def _begin(self) -> None:
        self._battery, self._opened_s = None, time.monotonic()
        self._skipped = self._decoder.skipped
        if self._every_s:
            self.link.write(encode(BatteryRequest()))

    def _forget(self) -> None:
        self._away.set()
        self._battery, self._opened_s = None, math.inf

    def _hear(self, data: bytes) -> None:
        for frame in self._decoder.feed(data):
            if isinstance(frame, Battery):
                self._heard_s, self._skipped = time.monotonic(), self._decoder.skipped
                if self._battery is None:
                    self._say.info(_ANSWERS, volts=frame.millivolts / 1000)
                self._battery = frame
                if frame.millivolts < 1000 * self._node.values["battery_low"]:
                    self._say.warn(_LOW, every_s=_LOW_EVERY_S, volts=frame.millivolts / 1000)
