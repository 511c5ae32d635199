"""The state of a microphone or a loudspeaker, for /diagnostics."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from nodes.drivers.sound_device import IN
from nodes.drivers.sound_words import CANNOT, FAULTY, OFF, SINCE

if TYPE_CHECKING:
    from nodes.drivers.sound_port import SoundPort
    from nodes.parts.translated_logger import TranslatedLogger


class PortStatus:
    """Makes the message: the device, time connected, bytes and errors per second."""

    def __init__(self, say: TranslatedLogger, name: str, port: SoundPort) -> None:
        self._say, self._name, self._port = say, name, port
        self._told = (time.monotonic(), 0, 0)

    def message(self) -> DiagnosticStatus:
        """Return the current state; rates are those since the last message."""
        port, now_s = self._port, time.monotonic()
        counts = port.octets, port.faults
        passed_s = max(1e-3, now_s - self._told[0])
        octets, faults = ((new - old) / passed_s for new, old in zip(counts, self._told[1:], strict=True))
        self._told = (now_s, *counts)
        level, words = self._state(faults)
        values = {
            "port": port.device or port.wanted,
            "connected": str(port.connected).lower(),
            "connected_since": port.since,
            "seconds": f"{now_s - port.since_s:.1f}",
            "connections": str(port.connections),
            "reconnects": str(max(0, port.connections - 1)),
            "bytes_in_per_s": f"{octets if port.way == IN else 0:.0f}",
            "bytes_out_per_s": f"{0 if port.way == IN else octets:.0f}",
            "errors_per_s": f"{faults:.1f}",
            "errors": str(port.faults),
            "sample_rate": str(port.rate_hz),
        }
        return DiagnosticStatus(
            level=level,
            name=self._name,
            message=words,
            hardware_id=values["port"],
            values=[KeyValue(key=key, value=value) for key, value in values.items()],
        )

    def _state(self, faults: float) -> tuple[bytes, str]:
        port, say = self._port, self._say
        if not port.wants:
            return DiagnosticStatus.OK, say.text(OFF)
        if not port.connected:
            return DiagnosticStatus.ERROR, say.text(CANNOT[port.way], problem=port.problem)
        seconds = time.monotonic() - port.since_s
        words = say.text(SINCE[port.way], device=port.device, rate=port.rate_hz, seconds=seconds)
        if faults:
            return DiagnosticStatus.WARN, say.text(FAULTY, words=words, faults=faults)
        return DiagnosticStatus.OK, words
