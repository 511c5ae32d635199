"""The format in which drivers report frames on `~/frames`: one line of JSON per frame.

`{"t": 1700000000.123, "way": "in", "kind": "frame", "hex": "5959...", "text": "distance 1.23 m"}`
with the time in Unix seconds. A batch has at most `MOST` frames; a last line of kind `more` says
how many more there were.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robot.frames.protocols import FrameKind
from text.nested import read_json

if TYPE_CHECKING:
    from collections.abc import Sequence

MOST = 200
"""Maximum frames per batch."""
MOST_OCTETS = 128
"""Reported bytes per frame; for noise the text says how many there were."""
LONGEST_TEXT = 400
WAYS = ("in", "out")


@dataclass(frozen=True, slots=True)
class FrameLine:
    """A frame on a serial line as it is shown and logged, or a count of frames that were left out."""

    time_s: float
    way: str
    """`in` from the device, or `out` to it."""
    kind: FrameKind
    octets: bytes
    text: str
    count: int = 0
    """For kind `more`: the number of frames."""


def encode(lines: Sequence[FrameLine]) -> str:
    """Encode the lines of a batch."""
    return "\n".join(map(_encoded, lines))


def _encoded(line: FrameLine) -> str:
    fields: dict[str, object] = {
        "t": round(line.time_s, 6),
        "way": line.way,
        "kind": line.kind.value,
        "hex": line.octets[:MOST_OCTETS].hex(),
        "text": line.text,
    }
    if line.kind is FrameKind.MORE:
        fields["count"] = line.count
    return json.dumps(fields, ensure_ascii=False, separators=(",", ":"))


def decode(text: str) -> tuple[list[FrameLine], int]:
    """Return the frames of an untrusted batch, and how many of its lines were invalid.

    Lines beyond twice `MOST` are not parsed, but counted as invalid.
    """
    lines = text.split("\n") if text else []
    read = [_decoded(line) for line in lines[: 2 * MOST]]
    found = [line for line in read if line is not None]
    return found, len(lines) - len(found)


def _decoded(line: str) -> FrameLine | None:
    try:
        fields = read_json(line[:10_000])
        time_s, way, text = float(fields["t"]), fields["way"], fields["text"]
        octets = bytes.fromhex(fields.get("hex", ""))
        kind, count = FrameKind(fields.get("kind", "frame")), int(fields.get("count", 0))
    except (ValueError, TypeError, KeyError, AttributeError, OverflowError):
        return None
    if way not in WAYS or not isinstance(text, str) or not math.isfinite(time_s):
        return None
    return FrameLine(time_s, way, kind, octets[:MOST_OCTETS], text[:LONGEST_TEXT], max(0, count))
