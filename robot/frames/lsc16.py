"""Frames of the LSC-16 servo controller in words, in both directions."""

from __future__ import annotations

from robot.frames.protocols import FrameKind, FramePhrases, FramePiece, HeadedReader
from robot.wire.lsc16 import ActionComplete, ActionRun, ActionStop, Battery, ServoFrame, ServoMove, decode
from text.i18n import N_

_HEAD = b"\x55\x55"
_LENGTHS = range(2, 54)
"""Valid values of the third byte: params + 2, with 16 servos at most."""
_PHRASES = {
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
        self._words = FramePhrases(language, _PHRASES)
        super().__init__(language, _HEAD, _length, self._read)

    def _read(self, octets: bytes) -> FramePiece:
        frame = decode(octets)
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


def _length(start: bytes) -> int:
    """Return the bytes of the frame; for an impossible length, the bytes of the header alone."""
    if len(start) < 3:
        return 0
    return start[2] + 2 if start[2] in _LENGTHS else len(_HEAD)
