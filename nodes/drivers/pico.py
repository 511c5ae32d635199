"""The computer's side of the Pico protocol: handshake, drive lines, counts of the replies.

`heard` runs on the reader's thread, everything else on the node's.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Iterable

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from nodes.drivers.serial_link import SerialLink
from nodes.parts.commands import Refusal
from nodes.parts.node import LessonNode, TranslatedLogger
from robot.frames.readers import PicoReader
from robot.wire import pico as wire
from text.i18n import N_

STARTED = N_("The chassis at {port} obeys {topic}")
COMMAND_OLD = N_("No wheel command for {seconds:g} s: stop")
TOO_FAST = N_("A wheel should turn at {speed:.1f} rad/s, the limit is {fastest:g}: both are slowed")
EMERGENCY = N_("EMERGENCY STOP: the wheels stand until it is released")
RELEASED = N_("The emergency stop is released; waiting for a new command")
_REFUSED_BY_PICO = N_("The Pico has refused {count} lines: damaged on their way, or more than its config.py allows")
STANDS = N_("The wheels stand: {reasons}")
_DRIVES = N_("ready to drive")
_NO_ANSWER = N_("no Pico answers at {port}")
_REFUSED = N_("refused: {refused}")
_FLAGS = {
    "E": N_("emergency stop"),
    "W": N_("no drive line for 250 ms"),
    "L": N_("fault of the left motor driver"),
    "R": N_("fault of the right motor driver"),
    "U": N_("the battery is weak"),
    "H": N_("no handshake"),
    "A": N_("waiting for a stop"),
}
_BAD = frozenset("LRUH")
"""Flags that indicate a fault."""
_SAY_EVERY_S = 10.0


def reasons(say: TranslatedLogger, flags: Iterable[str]) -> str:
    """Return why the wheels stand, in words."""
    return ", ".join(say.text(phrase) for flag, phrase in _FLAGS.items() if flag in flags)


class StandstillLogger:
    """Logs why the wheels stand still: at once, and again for those who look later.

    Also logs lines that the Pico refuses, which makes them stand for a moment.
    """

    def __init__(self, say: TranslatedLogger) -> None:
        self._say = say
        self._flags: frozenset[str] = frozenset()
        self._refused: int | None = None

    def tell(self, telemetry: wire.Telemetry | None) -> None:
        """Report the Pico's newest telemetry, None without any; call this at any rate."""
        flags = telemetry.flags & _BAD if telemetry is not None else frozenset()
        if flags:
            every_s = 0.0 if flags - self._flags else _SAY_EVERY_S
            self._say.error(STANDS, every_s=every_s, reasons=reasons(self._say, flags))
        self._flags = flags
        self._tell_refused(None if telemetry is None else telemetry.refused)

    def _tell_refused(self, count: int | None) -> None:
        """Report how many lines the Pico has refused since its start, None if unknown."""
        before = self._refused
        if (
            count is None
            or before is None
            or count < before
            or (count > before and self._say.warn(_REFUSED_BY_PICO, every_s=_SAY_EVERY_S, count=count - before))
        ):
            self._refused = count


def diagnosis(
    say: TranslatedLogger, status: DiagnosticStatus, pico: PicoClient, emergency: bool, refused: Refusal | None
) -> DiagnosticStatus:
    """Add the state of the Pico to that of the port, for programs and for people."""
    telemetry = pico.telemetry
    status.values.append(KeyValue(key="emergency_stop", value=str(emergency).lower()))
    status.values.append(KeyValue(key="refused", value=refused.told if refused else ""))
    if telemetry is None or not pico.answers:
        if pico.link.connected:
            status.level = DiagnosticStatus.ERROR
            status.message = say.text(_NO_ANSWER, port=pico.link.port)
        return status
    measured = {"battery_v": telemetry.battery_v, "left_a": telemetry.left_a, "right_a": telemetry.right_a}
    values = {
        "flags": "".join(sorted(telemetry.flags)) or "-",
        "refused_by_pico": str(telemetry.refused),
        "lost": str(pico.lost),
        **{key: "" if value is None else f"{value:.2f}" for key, value in measured.items()},
    }
    status.values += [KeyValue(key=key, value=value) for key, value in values.items()]
    why = reasons(say, telemetry.flags)
    status.message = say.text(STANDS, reasons=why) if why else say.text(_DRIVES)
    if refused:
        status.message += "; " + say.text(_REFUSED, refused=refused.words)
        status.level = DiagnosticStatus.WARN
    if why:
        bad = telemetry.flags & _BAD
        status.level = DiagnosticStatus.ERROR if bad else DiagnosticStatus.WARN
    return status


_HELLO_EVERY_S = 0.3
SILENT_AFTER_S = 0.5

_WELCOME = N_("The Pico answers: firmware {firmware}, protocol {protocol}")
_OTHER_PROTOCOL = N_("The Pico speaks protocol {theirs}, this program {ours}: the wheels stand; flash firmware/pico2")
_SILENT = N_("{port} is open, but no Pico answers: another device, or no firmware on it?")


class PicoClient:
    """Communicates over a `SerialLink`; `start` and `close` that."""

    def __init__(self, node: LessonNode, baud: int, heard: Callable[[wire.Telemetry], None]) -> None:
        self._say, self._heard = node.say, heard
        self.link = SerialLink(node, baud, self._hear, self._opened, self._forget, PicoReader)
        self._lock = threading.Lock()
        self._decoder = wire.PicoDecoder()
        self._sequence = 0
        self._greeted_s = 0.0
        self._heard_s, self._opened_s = 0.0, math.inf
        self.telemetry: wire.Telemetry | None = None
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
        self._send(lambda seq: wire.Drive(seq, left_rad_s, right_rad_s, steering_rad))
        if self.silent:
            self._say.warn(_SILENT, every_s=10.0, port=self.link.port)

    def halt(self) -> None:
        """Latch the emergency stop."""
        self._send(wire.Halt)

    def release(self) -> None:
        self._send(wire.Release)

    def _send(self, build: Callable[[int], wire.Message]) -> None:
        with self._lock:
            line = wire.encode(build(self._sequence))
            if self.link.write(line):
                self._sequence = (self._sequence + 1) % wire.SEQUENCES

    def _greet_again(self) -> None:
        if time.monotonic() - self._greeted_s > _HELLO_EVERY_S:
            self._greet()

    # ---------------------------------------------------------------- the reader's thread

    def _opened(self) -> None:
        self._opened_s = time.monotonic()
        self._greet()

    def _greet(self) -> None:
        self._greeted_s = time.monotonic()
        self._send(wire.Hello)

    def _forget(self) -> None:
        self.telemetry, self._opened_s = None, math.inf

    def _hear(self, data: bytes) -> None:
        for message in self._decoder.feed(data):
            self.frames += 1
            if isinstance(message, wire.Welcome):
                self._welcome(message)
            elif isinstance(message, wire.Telemetry):
                last, self.telemetry = self.telemetry, message
                self._heard_s = time.monotonic()
                if last is not None and last.uptime_ms <= message.uptime_ms:
                    self.lost += max(0, (message.seq - last.seq) % wire.SEQUENCES - 1) % 1000
                self._heard(message)

    def _welcome(self, message: wire.Welcome) -> None:
        if message.protocol == wire.PROTOCOL:
            self._say.info(_WELCOME, every_s=1.0, firmware=message.firmware, protocol=message.protocol)
        else:
            self._say.error(_OTHER_PROTOCOL, every_s=10.0, theirs=message.protocol, ours=wire.PROTOCOL)
