"""Messages for /tf as their bytes, written here without ROS."""

from __future__ import annotations

import struct
from typing import NamedTuple

NO_TURN = (0.0, 0.0, 0.0, 1.0)


class Sent(NamedTuple):
    """One transform as its publisher sends it."""

    parent: str
    child: str
    stamp_s: float = 0.0
    translation: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotation: tuple[float, float, float, float] = NO_TURN


def cdr(*sent: Sent, filler: bytes = b"\0") -> bytes:
    """The bytes of a message; `filler` is in the gaps, where rmw leaves whatever was there.

    Layout: OMG DDS-XTypes 1.3, 7.4.1, plain CDR, numbers aligned to their size.
    """
    body = bytearray(struct.pack("<I", len(sent)))

    def align(size: int) -> None:
        body.extend(filler * (-len(body) % size))

    for one in sent:
        align(4)
        seconds = int(one.stamp_s // 1)
        body.extend(struct.pack("<iI", seconds, round((one.stamp_s - seconds) * 1e9)))
        for name in (one.parent, one.child):
            align(4)
            text = name.encode() + b"\0"
            body.extend(struct.pack("<I", len(text)) + text)
        align(8)
        body.extend(struct.pack("<7d", *one.translation, *one.rotation))
    return b"\x00\x01\x00\x00" + bytes(body)
