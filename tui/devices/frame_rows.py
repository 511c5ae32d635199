"""Frames of a serial port as log lines: the node is the direction, and bad frames are errors."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from launcher.status import LogLine, Severity
from robot.frames.protocols import MOST_OCTETS, FrameKind, FrameLine
from text.i18n import N_, _
from tui.log_view.rows import LogColumns

if TYPE_CHECKING:
    from collections.abc import Sequence

KEPT = 2000
"""Frames kept for each port."""
WAYS = {"in": N_("← in"), "out": N_("→ out")}
_SEVERITIES = {
    FrameKind.FRAME: Severity.INFO,
    FrameKind.NOISE: Severity.WARN,
    FrameKind.BAD: Severity.ERROR,
    FrameKind.MORE: Severity.INFO,
}
_MARKS = {FrameKind.NOISE: "~ ", FrameKind.BAD: "✗ ", FrameKind.MORE: "⋯ "}
_READABLE = 4
"""Fewer bytes are not treated as text, even if all of them are letters."""
_WIDEST = 64
"""Text up to this many cells is padded, so that the bytes after it form a column."""
_WAY_CELLS = 6


class FrameRows:
    """Keeps the frames of a port, and turns them into lines in the current language."""

    def __init__(self) -> None:
        self._kept: deque[FrameLine] = deque(maxlen=KEPT)
        self._numbers = dict.fromkeys(WAYS, 0)
        self._width = 0
        self.as_hex = False
        """Whether to show bytes in hex even if they are readable text."""

    def clear(self) -> None:
        self._kept.clear()
        self._width = 0

    def add(self, frames: Sequence[FrameLine]) -> bool:
        """Add frames; return whether lines that are already shown look different as a result."""
        self._kept.extend(frames)
        width = max((len(_said(frame)) for frame in frames), default=0)
        width = min(_WIDEST, width)
        wider, self._width = width > self._width, max(width, self._width)
        return wider

    def lines(self, frames: Sequence[FrameLine] | None = None) -> list[LogLine]:
        """Return these frames as lines, by default all that are kept."""
        return [self._line(frame) for frame in (self._kept if frames is None else frames)]

    def _line(self, frame: FrameLine) -> LogLine:
        self._numbers[frame.way] += 1
        text = _said(frame)
        if frame.octets:
            text = f"{text:<{self._width}}  {octets_text(frame.octets, as_hex=self.as_hex)}"
        way, number = _(WAYS[frame.way]), self._numbers[frame.way]
        return LogLine(way, number, frame.time_s, _SEVERITIES[frame.kind], text, source="frames")


def _said(frame: FrameLine) -> str:
    return _MARKS.get(frame.kind, "") + frame.text


def octets_text(octets: bytes, *, as_hex: bool = False) -> str:
    """Return bytes as text if they are a line of text, otherwise in hex."""
    more = " …" if len(octets) >= MOST_OCTETS else ""
    line = octets.rstrip(b"\r\n")
    if not as_hex and len(line) >= _READABLE and all(0x20 <= octet < 0x7F for octet in line):
        return line.decode("ascii") + more
    return octets.hex(" ").upper() + more


def frame_columns(width: int, longest_node: int) -> LogColumns:
    """Columns for time, in milliseconds if they fit, and direction; the text marks the severity."""
    del longest_node
    return LogColumns(12 if width >= 60 else 8, 0, _WAY_CELLS)
