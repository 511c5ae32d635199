"""The emergency stop among the bytes that the terminal sends, found before anything is parsed.

A key is found in sequences of any protocol, whatever came before it. What is inside something
unfinished, such as a paste whose end got lost, may be content or a key that nobody would ever see:
if the end does not come soon after it, it is a key. When in doubt, the robot stops.
"""

from __future__ import annotations

from enum import Enum, auto
from functools import lru_cache
from typing import TYPE_CHECKING

from tui import clock
from tui.terminal.alt_keys import AltKeyParser

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

UNFINISHED_S = 0.3
"""A stop key counts if what it is inside of has not ended this long after it, and without delay
if nothing has come for this long."""
PASTE_BEGIN, PASTE_END = "\x1b[200~", "\x1b[201~"
ESC, CANCEL, SUBSTITUTE, BELL = 0x1B, 0x18, 0x1A, 0x07
MOUSE_BYTES, LEAST_MOUSE = 3, 0x20
"""After `CSI M`, where the terminal knows no newer protocol: the button and two coordinates, each
with 32 added. Source: xterm, ctlseqs, "Normal tracking mode"."""
MOST_BYTES = 64
"""No longer sequence is a key."""


class _At(Enum):
    """Where in the stream the next byte is. Names as in ECMA-48, 5.3 and 5.6."""

    GROUND = auto()
    ESCAPE = auto()
    CONTROL = auto()
    """After CSI."""
    SHIFT = auto()
    """After SS3."""
    MOUSE = auto()
    STRING = auto()
    """In the string of OSC, DCS, SOS, PM or APC."""
    STRING_ESCAPE = auto()


class StopScan:
    """Finds the keys that stop; for one thread."""

    def __init__(self, is_stop: Callable[[str], bool], now_s: Callable[[], float] = clock.steady) -> None:
        """Ask `is_stop` about each key, in Textual's notation, whether it stops now."""
        self._is_stop = is_stop
        self._now_s = now_s
        self._at = _At.GROUND
        self._sequence = bytearray()
        self._mouse_left = 0
        self._pasting = False
        self._paste_is_old = False
        """Whether it has paused for so long that it is a paste no more."""
        self._came_s = now_s()
        self._doubt_s: float | None = None
        """When a stop key came that is inside something unfinished."""

    @property
    def pasting_s(self) -> float:
        """For how long nothing has come of a paste that has not ended; 0.0 without one."""
        return self._now_s() - self._came_s if self._pasting else 0.0

    def cut(self, data: bytes) -> Iterator[tuple[bytes, bool]]:
        """Yield `data` in pieces, each with whether its last byte completes a stop key."""
        now_s = self._now_s()
        if now_s - self._came_s >= UNFINISHED_S:
            self._at = _At.GROUND
            self._paste_is_old = self._pasting
        self._came_s = now_s
        begin = 0
        for at, byte in enumerate(data, 1):
            if self._take(byte):
                yield data[begin:at], True
                begin = at
        if begin < len(data):
            yield data[begin:], False

    def overdue(self) -> bool:
        """Whether a stop key came in something whose end is overdue; to be asked now and then."""
        if self._doubt_s is None or self._now_s() - self._doubt_s < UNFINISHED_S:
            return False
        self._doubt_s = None
        self._at = _At.GROUND
        self._paste_is_old = self._pasting
        return True

    def end_paste(self) -> None:
        """Take what comes for keys again."""
        self._pasting = self._paste_is_old = False

    def _take(self, byte: int) -> bool:
        """Go on by a byte; return whether it completes a stop key."""
        at = self._at
        if at is _At.ESCAPE:
            return self._escape(byte)
        if at is _At.CONTROL:
            return self._control(byte)
        if at is _At.SHIFT:
            self._at = _At.GROUND
            return self._complete(byte) or self._ground(byte, shifted=True)
        if at is _At.MOUSE and byte >= LEAST_MOUSE:
            self._mouse_left -= 1
            self._at = _At.MOUSE if self._mouse_left else _At.GROUND
            return False
        if at in (_At.GROUND, _At.MOUSE):
            self._at = _At.GROUND
            return self._ground(byte)
        return self._string(byte)

    def _ground(self, byte: int, *, shifted: bool = False) -> bool:
        if byte == ESC:
            self._at = _At.ESCAPE
            self._sequence[:] = (byte,)
            return False
        # Of SS3 with a letter nothing is a key but the whole.
        return not (shifted and byte > 0x20) and self._key(chr(byte))

    def _escape(self, byte: int) -> bool:
        """After ESC, which may also have been a key of its own, pressed just before."""
        self._at = _At.GROUND
        if byte == ESC:
            return self._ground(byte)
        self._sequence.append(byte)
        if byte in b"[O":
            self._at = _At.CONTROL if byte == ord("[") else _At.SHIFT
        elif byte in b"]PX^_":
            self._at = _At.STRING
        else:
            return byte <= 0x20 and self._key(chr(byte))
        return False

    def _control(self, byte: int) -> bool:
        if 0x40 <= byte <= 0x7E:
            self._at = _At.GROUND
            return self._complete(byte)
        if not 0x20 <= byte <= 0x3F:
            # Whatever it is, it is no part of a sequence, and ends it.
            self._at = _At.GROUND
            return self._ground(byte)
        if len(self._sequence) < MOST_BYTES:
            self._sequence.append(byte)
        self._suspect(byte)
        return False

    def _complete(self, byte: int) -> bool:
        sequence = (self._sequence + bytes((byte,))).decode("latin-1")
        if not self._pasting:
            self._doubt_s = None
        if sequence == PASTE_BEGIN:
            self._pasting, self._paste_is_old = True, False
        elif sequence == PASTE_END:
            self.end_paste()
            self._doubt_s = None
        elif sequence == "\x1b[M":
            self._at, self._mouse_left = _At.MOUSE, MOUSE_BYTES
        else:
            return self._key(sequence)
        return False

    def _string(self, byte: int) -> bool:
        if self._at is _At.STRING_ESCAPE:
            if byte == ord("\\"):
                self._end_string()
                return False
            self._sequence[:] = (ESC,)
            return self._escape(byte)
        if byte in (CANCEL, SUBSTITUTE):
            self._at = _At.GROUND
            return self._ground(byte)
        if byte == BELL:
            self._end_string()
        elif byte == ESC:
            self._at = _At.STRING_ESCAPE
        else:
            self._suspect(byte)
        return False

    def _end_string(self) -> None:
        self._at = _At.GROUND
        if not self._pasting:
            self._doubt_s = None

    def _suspect(self, byte: int) -> None:
        """Remember a byte of something unfinished that would otherwise be a stop key."""
        if self._doubt_s is None and byte <= 0x20 and self._stops(chr(byte)):
            self._doubt_s = self._now_s()

    def _key(self, sequence: str) -> bool:
        """Return whether this key stops now; in a paste that is seen only later."""
        if not self._stops(sequence):
            return False
        if self._pasting and not self._paste_is_old:
            if self._doubt_s is None:
                self._doubt_s = self._now_s()
            return False
        return True

    def _stops(self, sequence: str) -> bool:
        return any(map(self._is_stop, key_names(sequence)))


@lru_cache(1024)
def key_names(sequence: str) -> tuple[str, ...]:
    """Return the keys that a sequence of bytes, one a character, stands for."""
    return tuple(event.key for event in AltKeyParser()._sequence_to_key_events(sequence))  # noqa: SLF001 - Textual has no other way to name a key
