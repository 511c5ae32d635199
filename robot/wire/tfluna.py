"""Frames of the Benewake ToF sonars: TF-Luna, TFmini-S and TFmini Plus.

`59 59 DistL DistH StrL StrH TempL TempH CK`: centimetres, strength, eighths of a degree above
-256 C, low byte of the sum. A sum is a weak check and 59 may occur anywhere, so a frame that does
not directly follow a good one is accepted only if another good one follows it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

from robot.wire.line import sum8

BAUD = 115_200
SIZE = 9
_HEAD = b"\x59\x59"
_STRENGTH_MIN = 100
_OVEREXPOSED = 65_535
_WEAK_CM, _SATURATED_CM, _AMBIENT_CM = 65_535, 65_534, 65_532


class Model(str, Enum):
    """The sensor model: models report bad readings in different ways."""

    LUNA = "tf_luna"
    MINI_S = "tfmini_s"

    @property
    def range_m(self) -> tuple[float, float]:
        """The shortest and the longest distance that it can measure."""
        return (0.2, 8.0) if self is Model.LUNA else (0.1, 12.0)

    @property
    def view_rad(self) -> float:
        """The opening angle of its beam."""
        return math.radians(2.0 if self is Model.LUNA else 2.3)


@dataclass(frozen=True)
class TofFrame:
    """One reading, as it came."""

    distance_cm: int
    strength: int
    temperature_c: float

    def distance_m(self, model: Model) -> float:
        """By REP-117: +inf nothing in range, -inf too close to measure, nan no valid reading."""
        if model is Model.LUNA:
            if self.strength == _OVEREXPOSED:
                return math.nan
            if self.strength < _STRENGTH_MIN:
                # A distance with so weak an echo is not valid.
                return math.nan if self.distance_cm else math.inf
        elif self.distance_cm == _WEAK_CM:
            return math.inf
        elif self.distance_cm in (_SATURATED_CM, _AMBIENT_CM):
            return math.nan
        # 0 means "no return"; together with a strong echo that is a contradiction.
        return math.nan if self.distance_cm == 0 else _in_range(self.distance_cm / 100, model)


def _in_range(metres: float, model: Model) -> float:
    nearest, farthest = model.range_m
    if metres < nearest:
        return -math.inf
    return metres if metres <= farthest else math.inf


def encode(frame: TofFrame) -> bytes:
    """Return the nine bytes of a reading; raises ValueError for values that do not fit."""
    raw = round((frame.temperature_c + 256) * 8)
    try:
        words = (frame.distance_cm, frame.strength, raw)
        data = _HEAD + b"".join(word.to_bytes(2, "little") for word in words)
    except OverflowError:
        raise ValueError(f"out of range: {frame}") from None
    return data + bytes([sum8(data)])


def decode(data: bytes) -> TofFrame | None:
    """Return the reading in nine bytes, None if they are not a frame."""
    if len(data) != SIZE or data[:2] != _HEAD or sum8(data[:-1]) != data[-1]:
        return None
    distance, strength, raw = (int.from_bytes(data[at : at + 2], "little") for at in (2, 4, 6))
    return TofFrame(distance, strength, raw / 8 - 256)


class TofDecoder:
    """Finds readings in a stream of arbitrary pieces; buffers less than two frames."""

    def __init__(self) -> None:
        self.frames = 0
        self.skipped = 0
        """Bytes so far that belonged to no frame."""
        self.errors = 0
        """How often the stream was invalid where a frame should have begun."""
        self._rest = b""
        self._in_step = False

    def feed(self, data: bytes) -> list[TofFrame]:
        """Return the readings that these bytes complete, oldest first."""
        stream, at = self._rest + data, 0
        found: list[TofFrame] = []
        while len(stream) - at >= SIZE:
            frame = decode(stream[at : at + SIZE])
            if frame is not None and not self._in_step:
                if len(stream) - at < 2 * SIZE:
                    break
                self._in_step = decode(stream[at + SIZE : at + 2 * SIZE]) is not None
            if frame is not None and self._in_step:
                found.append(frame)
                at += SIZE
            else:
                at = self._skip(stream, at)
        self._rest = stream[at:]
        self.frames += len(found)
        return found

    def _skip(self, stream: bytes, at: int) -> int:
        """Return the place of the next byte that may begin a frame."""
        self.errors += self._in_step
        self._in_step = False
        after = stream.find(_HEAD[:1], at + 1)
        after = len(stream) if after < 0 else after
        self.skipped += after - at
        return after
