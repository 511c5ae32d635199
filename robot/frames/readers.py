"""Frames of the serial devices in words, in both directions."""

from __future__ import annotations

import math
import re

from robot.frames.protocols import FrameKind, FramePhrases, FramePiece, HeadedReader, noise
from robot.wire.line import LONGEST, crc16, sum8, unwrap
from robot.wire.lsc16 import ActionComplete, ActionRun, ActionStop, Battery, ServoFrame, ServoMove
from robot.wire.lsc16 import decode as decode_servos
from robot.wire.pico import FLAGS, Drive, Halt, Hello, Message, Telemetry, Welcome, parse
from robot.wire.tfluna import SIZE, Model, TofFrame
from robot.wire.tfluna import decode as decode_tof
from text.i18n import N_, translated

_TOF_HEAD = b"\x59\x59"
_TOF = {
    "distance": N_("distance {metres:.2f} m"),
    "far": N_("nothing in range ({centimetres} cm)"),
    "near": N_("too close to measure ({centimetres} cm)"),
    "none": N_("no valid reading ({centimetres} cm)"),
    "rest": N_(", strength {strength}, {celsius:.1f} °C"),
    "bad": N_("CHECKSUM FAILED: got {told:02X}, expected {counted:02X}"),
}


class TofReader(HeadedReader):
    """Reads the frames of a sonar; bytes sent to it are shown as noise."""

    def __init__(self, language: str, model: Model = Model.LUNA) -> None:
        self._words, self._model = FramePhrases(language, _TOF), model
        super().__init__(language, _TOF_HEAD, _tof_length, self._read)

    def _read(self, octets: bytes) -> FramePiece:
        frame = decode_tof(octets)
        if frame is not None:
            return FramePiece(octets, self._said(frame))
        said = self._words("bad", told=octets[-1], counted=sum8(octets[:-1]))
        return FramePiece(octets, said, FrameKind.BAD)

    def _said(self, frame: TofFrame) -> str:
        metres = frame.distance_m(self._model)
        key = "distance"
        if not math.isfinite(metres):
            key = "none" if math.isnan(metres) else "far" if metres > 0 else "near"
        first = self._words(key, metres=metres, centimetres=frame.distance_cm)
        return first + self._words("rest", strength=frame.strength, celsius=frame.temperature_c)


def _tof_length(_start: bytes) -> int:
    return SIZE


_SERVO_HEAD = b"\x55\x55"
_SERVO_LENGTHS = range(2, 54)
"""Valid values of the third byte: params + 2, with 16 servos at most."""
_SERVO = {
    "move": N_("move in {time} ms: {servos}"),
    "servo": N_("servo {servo} to {pulse} us"),
    "run": N_("group {group} runs {times} times"),
    "complete": N_("group {group} has ended ({times} times)"),
    "stop": N_("group stops"),
    "ask": N_("battery voltage?"),
    "battery": N_("battery {volts:.2f} V"),
    "bad": N_("NOT AN LSC-16 FRAME"),
}


class ServoReader(HeadedReader):
    """Reads frames to or from the controller."""

    def __init__(self, language: str) -> None:
        self._words = FramePhrases(language, _SERVO)
        super().__init__(language, _SERVO_HEAD, _servo_length, self._read)

    def _read(self, octets: bytes) -> FramePiece:
        frame = decode_servos(octets)
        if frame is None:
            return FramePiece(octets, self._words("bad"), FrameKind.BAD)
        return FramePiece(octets, self._said(frame))

    def _said(self, frame: ServoFrame) -> str:
        words = self._words
        if isinstance(frame, ServoMove):
            pairs = frame.pulses_us
            servos = ", ".join(words("servo", servo=servo, pulse=pulse) for servo, pulse in pairs)
            return words("move", time=frame.time_ms, servos=servos)
        if isinstance(frame, (ActionRun, ActionComplete)):
            key = "run" if isinstance(frame, ActionRun) else "complete"
            return words(key, group=frame.group, times=frame.times)
        if isinstance(frame, Battery):
            return words("battery", volts=frame.millivolts / 1000)
        return words("stop" if isinstance(frame, ActionStop) else "ask")


def _servo_length(start: bytes) -> int:
    """Return the bytes of the frame; for an impossible length, the bytes of the header alone."""
    if len(start) < 3:
        return 0
    return start[2] + 2 if start[2] in _SERVO_LENGTHS else len(_SERVO_HEAD)


_LINE = re.compile(rb"([^\r\n]*)[\r\n]+")
_CHECKED = re.compile(rb"\$([^$*]*)\*([0-9A-Fa-f]{4})")
_PICO = {
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
        self._language, self._words = language, FramePhrases(language, _PICO)
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
