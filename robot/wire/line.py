r"""Lines that a person can read and a program can trust: `$BODY*CRC\n`.

BODY is printable ASCII without `$` and `*`; CRC is the CRC-16 of BODY in four capital hex digits.
Whatever comes before the last `$` of a line is noise. CR ends a line as LF does.
"""

from __future__ import annotations

import binascii
import re


def crc16(data: bytes) -> int:
    """CRC-16/IBM-3740, also called CCITT-FALSE: polynomial 1021, initial value FFFF, 0..65535.

    In lines of up to 4 KiB it detects every error of one, two or three bits.
    """
    return binascii.crc_hqx(data, 0xFFFF)


def sum8(data: bytes) -> int:
    """The low byte of the sum, 0..255: detects every single-bit error, and few others."""
    return sum(data) & 0xFF


LONGEST = 128
"""Maximum bytes of a line, including its end."""
_LINE = re.compile(rb"\$([ -#%-)+-~]+)\*([0-9A-F]{4})")


def wrap(body: str) -> bytes:
    """Return the line for a body; raises ValueError for a body that no line can carry."""
    data = body.encode("ascii", "strict")
    line = b"$%s*%04X\n" % (data, crc16(data))
    if len(line) > LONGEST or _LINE.fullmatch(line[:-1]) is None:
        raise ValueError(f"no line can carry {body!r}")
    return line


def unwrap(line: bytes) -> str | None:
    """Return the body of a line without its end; None if malformed or its CRC is wrong."""
    found = _LINE.fullmatch(line)
    if found is None or crc16(found[1]) != int(found[2], 16):
        return None
    return found[1].decode("ascii")


class LineSplitter:
    """Finds the bodies in a stream of arbitrary pieces; buffers at most `LONGEST` bytes."""

    def __init__(self) -> None:
        self.bad = 0
        """Lines so far that were malformed, or had a wrong CRC."""
        self._rest = b""
        self._overlong = False

    def feed(self, data: bytes) -> list[str]:
        """Return the bodies of the lines that these bytes complete, oldest first."""
        *ended, rest = (self._rest + data.replace(b"\r", b"\n")).split(b"\n")
        bodies = [body for line in ended if (body := self._take(line)) is not None]
        self._overlong = self._overlong or len(rest) >= LONGEST
        self._rest = rest[-LONGEST:]
        return bodies

    def _take(self, line: bytes) -> str | None:
        overlong, self._overlong = self._overlong, False
        if not line and not overlong:
            return None
        start = line.rfind(b"$")
        body = unwrap(line[start:]) if start >= 0 and len(line) - start < LONGEST else None
        self.bad += body is None or overlong or start > 0
        return body
