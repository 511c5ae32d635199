"""The log messages of the chassis, and the sentences about its state."""

from __future__ import annotations

from typing import TYPE_CHECKING

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Iterable

    from nodes.drivers.pico import PicoClient
    from nodes.parts.refusals import Refusal
    from nodes.parts.translated_logger import TranslatedLogger
    from robot.wire.pico import Telemetry
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

    def tell(self, telemetry: Telemetry | None) -> None:
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
