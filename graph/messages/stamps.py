"""The stamp in a message's header, read from its bytes without decoding the rest."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import Literal

HEADER = "std_msgs/Header"
NANOSECONDS = 1e-9
FARTHEST_S = 600.0
"""A stamp farther off than this is from another clock: a simulation, a bag, a board just booted."""
ENCAPSULATION = 4
"""Source: OMG DDS-XTypes 1.3, 7.6.3.1: two bytes give the representation, odd is little
endian; two are options. The body follows; its first field is not padded."""
LONGEST_NAME = 200
"""Bytes that are read of a frame's name."""
LITTLE, BIG = struct.Struct("<iI"), struct.Struct(">iI")


def delay_reader(cls: type[Any]) -> Callable[[bytes, float], float | None] | None:
    """Return a function for the delay of messages of this class, None if they have no header.

    It takes the serialized message and its arrival in unix time, and returns seconds; None for a
    stamp of zero. The delay is negative if the sender's clock is ahead; beyond `FARTHEST_S` it only
    says how far apart two clocks are.
    """
    fields: dict[str, str] = cls.get_fields_and_field_types()
    return delay_s if next(iter(fields.values()), "") == HEADER else None


def delay_s(raw: bytes, arrived_s: float) -> float | None:
    """Return arrival minus stamp, for a message that begins with a header."""
    if len(raw) < ENCAPSULATION + LITTLE.size:
        return None
    layout = LITTLE if raw[1] & 1 else BIG
    seconds, nanoseconds = layout.unpack_from(raw, ENCAPSULATION)
    if not seconds and not nanoseconds:
        return None
    passed_s: float = arrived_s - (seconds + nanoseconds * NANOSECONDS)
    return passed_s


def frame_id(raw: bytes) -> str:
    """Return the frame that the header at the beginning of a message names."""
    order: Literal["little", "big"] = "little" if raw[1:2] == b"\x01" else "big"
    begin = ENCAPSULATION + LITTLE.size + 4
    length = int.from_bytes(raw[begin - 4 : begin], order)
    name = raw[begin : begin + min(length, LONGEST_NAME)]
    return name.removesuffix(b"\0").decode(errors="replace")
