"""Splitting the bytes of a pipe into lines: any chunks, any length, redrawn progress bars."""

from __future__ import annotations

from dataclasses import dataclass

MAX_LINE_BYTES = 32 * 1024
"""A longer line is cut; the log file has all of it."""

_ERASE = b"\x1b[K"
_NO_LETTERS = bytes(code for code in range(128) if not chr(code).isalpha())

IDLE_S = 1.0
"""An unfinished line is shown after this time: it is a prompt or a progress bar."""


@dataclass(frozen=True)
class RawLine:
    """One line as its process wrote it, without the line end."""

    data: bytes
    lost: int = 0
    """Bytes that were cut from its end."""


class LineAssembler:
    """The lines of one stream; holds at most twice `MAX_LINE_BYTES` and one chunk.

    A carriage return starts the line again. The text before it becomes a line of its own, unless
    the text after it has the same words with other numbers: of a progress bar the newest state is
    enough.
    """

    def __init__(self) -> None:
        self._rest = b""
        self._lost = 0
        self._waits_since = 0.0
        self._state: RawLine | None = None
        """The text before the newest carriage return."""
        self._words = ""

    @property
    def unfinished(self) -> bool:
        return bool(self._rest) or self._state is not None

    def feed(self, chunk: bytes, now: float) -> list[RawLine]:
        """Take a chunk that was read at `now`; return the lines that it completes."""
        if self._state is None:
            self._waits_since = now
        *ended, self._rest = (self._rest + chunk).split(b"\n")
        done = [line for whole in ended for line in self._ended(whole)]
        *states, self._rest = self._rest.split(b"\r")
        done += self._rewritten(states)
        if len(self._rest) > MAX_LINE_BYTES:
            self._lost += len(self._rest) - MAX_LINE_BYTES
            self._rest = self._rest[:MAX_LINE_BYTES]
        return done

    def flush(self, now: float, *, at_end: bool = False) -> list[RawLine]:
        """Return the unfinished line if it is older than `IDLE_S`, or if the stream is `at_end`.

        Text that is added to it later becomes a line of its own.
        """
        if not self.unfinished or (now - self._waits_since < IDLE_S and not at_end):
            return []
        self._waits_since = now
        if at_end:
            line, self._rest = self._rest, b""
            return self._ended(line)
        if self._state is not None:
            # The text after it may be half of the next state.
            state, self._state = self._state, None
            return [state]
        keep = len(self._rest) - _half_character(self._rest)
        line, self._rest = self._rest[:keep], self._rest[keep:]
        return [self._line(line)] if line else []

    def _ended(self, line: bytes) -> list[RawLine]:
        """Return a finished line, preceded by those that carriage returns split off from it."""
        if self._state is None and b"\r" not in line:
            return [self._line(line)]
        states = line.split(b"\r")
        done = self._rewritten(states)
        last, self._state = self._state, None
        return [*done, last or self._line(states[-1])]

    def _rewritten(self, states: list[bytes]) -> list[RawLine]:
        """Take the successive states of a line; return those that are not replaced as progress."""
        done: list[RawLine] = []
        for state in states:
            if state.replace(_ERASE, b"").strip():
                words = _words(state)
                if self._state is not None and words != self._words:
                    done.append(self._state)
                self._state, self._words = self._line(state), words
        return done

    def _line(self, line: bytes) -> RawLine:
        lost, self._lost = self._lost, 0
        if len(line) > MAX_LINE_BYTES:
            lost += len(line) - MAX_LINE_BYTES
            line = line[:MAX_LINE_BYTES]
        return RawLine(line, lost)


def _words(state: bytes) -> str:
    """Return the letters only: a progress bar changes numbers, bars and blanks."""
    if state.isascii():
        return state.translate(None, _NO_LETTERS).decode()
    return "".join(filter(str.isalpha, state.decode(errors="replace")))


def _half_character(data: bytes) -> int:
    """Return how many bytes at the end are the beginning of a UTF-8 character, 0 to 3."""
    for back in range(1, min(3, len(data)) + 1):
        byte = data[-back]
        if byte >= 0xC0:
            length = 2 if byte < 0xE0 else 3 if byte < 0xF0 else 4
            return back if back < length else 0
        if byte < 0x80:
            return 0
    return 0
