"""Frames of the ToF sonars in words."""

from __future__ import annotations

import math

from robot.frames.protocols import FrameKind, FramePhrases, FramePiece, HeadedReader
from robot.wire.crc import sum8
from robot.wire.tfluna import SIZE, Model, TofFrame, decode
from text.i18n import N_

_HEAD = b"\x59\x59"
_PHRASES = {
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
        self._words, self._model = FramePhrases(language, _PHRASES), model
        super().__init__(language, _HEAD, _length, self._read)

    def _read(self, octets: bytes) -> FramePiece:
        frame = decode(octets)
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


def _length(_start: bytes) -> int:
    return SIZE
