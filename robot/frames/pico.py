"""Lines to and from the Pico in words (see docs/pico-protocol.md)."""

from __future__ import annotations

import re

from robot.frames.protocols import FrameKind, FramePhrases, FramePiece, noise
from robot.wire.crc import crc16
from robot.wire.line import LONGEST, unwrap
from robot.wire.pico import FLAGS, Drive, Halt, Hello, Message, Telemetry, Welcome, parse
from text.i18n import N_, translated

_LINE = re.compile(rb"([^\r\n]*)[\r\n]+")
_CHECKED = re.compile(rb"\$([^$*]*)\*([0-9A-Fa-f]{4})")
_PHRASES = {
    "hello": N_("hello, protocol {protocol}"),
    "drive": N_("drive left {left:.2f} right {right:.2f} rad/s steering {steering:.2f} rad"),
    "halt": N_("EMERGENCY STOP"),
    "release": N_("emergency stop released"),
    "welcome": N_("the Pico answers: firmware {firmware}, protocol {protocol}"),
    "telemetry": N_("wheels left {left:.2f} right {right:.2f} rad/s steering {steering:.2f} rad"),
    "battery": N_(", {value:.2f} V"),
    "left": N_(", left {value:.2f} A"),
    "right": N_(", right {value:.2f} A"),
    "flags": N_(", flags: {flags}"),
    "counts": N_(", obeyed {obeyed}, refused {refused}, up {uptime:.1f} s"),
    "end": N_(", seq {seq}, crc ok"),
    "failed": N_("CRC FAILED: got {told}, expected {counted:04X}"),
    "unknown": N_("UNKNOWN LINE, though its crc is right"),
    "cut": N_("INCOMPLETE LINE"),
}


class PicoReader:
    """Reads lines to or from the Pico."""

    def __init__(self, language: str) -> None:
        self._language, self._words = language, FramePhrases(language, _PHRASES)
        self._rest = b""

    def feed(self, data: bytes) -> list[FramePiece]:
        """Return the pieces that these bytes complete, oldest first."""
        stream, at = self._rest + data, 0
        found: list[FramePiece] = []
        for match in _LINE.finditer(stream):
            found += self._line(match[0], match[1])
            at = match.end()
        self._rest = stream[at:]
        return found + (self.flush() if len(self._rest) >= LONGEST else [])

    def flush(self) -> list[FramePiece]:
        """Return what is left of an incomplete line."""
        rest, self._rest = self._rest, b""
        return [noise(rest, self._language)] if rest else []

    def _line(self, octets: bytes, line: bytes) -> list[FramePiece]:
        """Return the pieces of a line, given with and without its line end."""
        start = line.rfind(b"$")
        if start < 0:
            return [noise(octets, self._language)] if line else []
        loose = [noise(octets[:start], self._language)] if start else []
        return [*loose, self._piece(octets[start:], line[start:])]

    def _piece(self, octets: bytes, line: bytes) -> FramePiece:
        body = unwrap(line) if len(line) < LONGEST else None
        if body is None:
            return FramePiece(octets, self._complaint(line), FrameKind.BAD)
        message = parse(body)
        if message is None:
            return FramePiece(octets, self._words("unknown"), FrameKind.BAD)
        return FramePiece(octets, self._said(message) + self._words("end", seq=message.seq))

    def _complaint(self, line: bytes) -> str:
        checked = _CHECKED.fullmatch(line)
        if checked is None or crc16(checked[1]) == int(checked[2], 16):
            return self._words("cut")
        return self._words("failed", told=checked[2].decode(), counted=crc16(checked[1]))

    def _said(self, message: Message) -> str:
        words = self._words
        if isinstance(message, Telemetry):
            return self._telemetry(message)
        if isinstance(message, Drive):
            return words("drive", left=message.left_rad_s, right=message.right_rad_s, steering=message.steering_rad)
        if isinstance(message, Hello):
            return words("hello", protocol=message.protocol)
        if isinstance(message, Welcome):
            return words("welcome", firmware=message.firmware, protocol=message.protocol)
        return words("halt" if isinstance(message, Halt) else "release")

    def _telemetry(self, message: Telemetry) -> str:
        words = self._words
        said = words("telemetry", left=message.left_rad_s, right=message.right_rad_s, steering=message.steering_rad)
        if message.flags:
            said += words("flags", flags=", ".join(self._named(message.flags)))
        if message.battery_v is not None:
            said += words("battery", value=message.battery_v)
        for side, value in (("left", message.left_a), ("right", message.right_a)):
            if value is not None:
                said += words(side, value=value)
        uptime_s = message.uptime_ms / 1000
        return said + words("counts", obeyed=message.obeyed, refused=message.refused, uptime=uptime_s)

    def _named(self, flags: frozenset[str]) -> list[str]:
        return [translated(name, self._language) for letter, name in FLAGS.items() if letter in flags]
