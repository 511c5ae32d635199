"""Frames of the LSC-16 servo controller, in both directions: `55 55 LEN CMD params`.

LEN is the number of params + 2, numbers are little-endian. There is no checksum and no answer to
a move: a frame is accepted only if its command is known and all its numbers are in range.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

from robot.limits import Limits

BAUD = 9600
PULSE = Limits(500, 2500, "us")
"""0 to 180 degrees."""
CENTRE_US = 1500
TIME = Limits(0, 30_000, "ms")
SERVO = Limits(1, 16, "")
BATTERY = Limits(0, 30_000, "mV")

_HEAD = b"\x55\x55"
_MOVE, _RUN, _STOP, _COMPLETE, _BATTERY = 3, 6, 7, 8, 15
_LONGEST_MOVE = 5 + 3 * int(SERVO.high)
_LENGTHS = {_RUN: (5,), _STOP: (2,), _COMPLETE: (5,), _BATTERY: (2, 4)}


@dataclass(frozen=True)
class ServoMove:
    """Servos to pulse widths (us), within `time_ms`."""

    time_ms: int
    pulses_us: tuple[tuple[int, int], ...]
    """Pairs of servo and pulse width."""


@dataclass(frozen=True)
class ActionRun:
    """A stored group runs, or has begun to."""

    group: int
    times: int


@dataclass(frozen=True)
class ActionStop:
    """A stored group stops, or was stopped."""


@dataclass(frozen=True)
class ActionComplete:
    """A stored group has finished."""

    group: int
    times: int


@dataclass(frozen=True)
class BatteryRequest:
    """Asks for the voltage."""


@dataclass(frozen=True)
class Battery:
    """The answer to a `BatteryRequest`: the voltage that feeds the servos."""

    millivolts: int


ServoFrame = ServoMove | ActionRun | ActionStop | ActionComplete | BatteryRequest | Battery


def encode(frame: ServoFrame) -> bytes:
    """Return the bytes of a frame; raises ValueError for values that the controller refuses."""
    try:
        command, params = _params(frame)
        data = _HEAD + bytes([len(params) + 2, command]) + params
    except (struct.error, ValueError):
        raise ValueError(f"out of range: {frame}") from None
    if decode(data) != frame:
        raise ValueError(f"out of range: {frame}")
    return data


def decode(data: bytes) -> ServoFrame | None:
    """Return the frame of exactly these bytes, None if they are not a frame."""
    if len(data) < 4 or data[:2] != _HEAD or data[2] != len(data) - 2:
        return None
    command, params = data[3], data[4:]
    if command == _MOVE:
        return _move(params)
    if command in (_RUN, _COMPLETE) and len(params) == 3:
        group, times = struct.unpack("<BH", params)
        return ActionRun(group, times) if command == _RUN else ActionComplete(group, times)
    if command == _STOP and not params:
        return ActionStop()
    if command == _BATTERY:
        return _battery(params)
    return None


def _params(frame: ServoFrame) -> tuple[int, bytes]:
    if isinstance(frame, ServoMove):
        head = struct.pack("<BH", len(frame.pulses_us), frame.time_ms)
        return _MOVE, head + b"".join(struct.pack("<BH", *pair) for pair in frame.pulses_us)
    if isinstance(frame, (ActionRun, ActionComplete)):
        command = _RUN if isinstance(frame, ActionRun) else _COMPLETE
        return command, struct.pack("<BH", frame.group, frame.times)
    if isinstance(frame, Battery):
        return _BATTERY, struct.pack("<H", frame.millivolts)
    return (_STOP, b"") if isinstance(frame, ActionStop) else (_BATTERY, b"")


def _move(params: bytes) -> ServoMove | None:
    if len(params) < 6 or len(params) != 3 + 3 * params[0]:
        return None
    _count, time_ms = struct.unpack_from("<BH", params)
    pairs = tuple(struct.iter_unpack("<BH", params[3:]))
    servos = [servo for servo, _pulse in pairs]
    if (
        time_ms not in TIME
        or len(set(servos)) != len(servos)
        or not all(servo in SERVO and pulse in PULSE for servo, pulse in pairs)
    ):
        return None
    return ServoMove(time_ms, pairs)


def _battery(params: bytes) -> BatteryRequest | Battery | None:
    if not params:
        return BatteryRequest()
    millivolts = int.from_bytes(params, "little")
    return Battery(millivolts) if len(params) == 2 and millivolts in BATTERY else None


class ServoDecoder:
    """Finds frames in a stream of arbitrary pieces; buffers less than one frame."""

    def __init__(self) -> None:
        self.frames = 0
        self.skipped = 0
        """Bytes so far that belonged to no frame."""
        self._rest = b""

    def feed(self, data: bytes) -> list[ServoFrame]:
        """Return the frames that these bytes complete, oldest first."""
        stream, at = self._rest + data, 0
        found: list[ServoFrame] = []
        while at < len(stream):
            size = _size(stream, at)
            if size > len(stream) - at:
                break
            frame = decode(stream[at : at + size]) if size else None
            if frame is not None:
                found.append(frame)
            at += size if frame is not None else 1
            self.skipped += frame is None
        self._rest = stream[at:]
        self.frames += len(found)
        return found


def _size(stream: bytes, at: int) -> int:
    """Return the bytes of the frame that may begin here, as far as known; 0 if none can."""
    head = stream[at : at + 4]
    if not _HEAD.startswith(head[:2]):
        return 0
    if len(head) < 4:
        return 4
    length, command = head[2], head[3]
    if command == _MOVE:
        known = length <= _LONGEST_MOVE and length >= 8 and (length - 5) % 3 == 0
    else:
        known = length in _LENGTHS.get(command, ())
    return length + 2 if known else 0
