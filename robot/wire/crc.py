"""The checksums of serial frames."""

from __future__ import annotations

import binascii


def crc16(data: bytes) -> int:
    """CRC-16/IBM-3740, also called CCITT-FALSE: polynomial 1021, initial value FFFF, 0..65535.

    In lines of up to 4 KiB it detects every error of one, two or three bits.
    """
    return binascii.crc_hqx(data, 0xFFFF)


def sum8(data: bytes) -> int:
    """The low byte of the sum, 0..255: detects every single-bit error, and few others."""
    return sum(data) & 0xFF
