"""Bytes of a pipe to lines: cut anywhere, of any length, with progress that rewrites its line."""

from __future__ import annotations

from dataclasses import dataclass

MAX_LINE_BYTES = 32 * 1024
"""A longer line is cut; the log file has the whole of it."""

IDLE_S = 1.0
"""A line without an end that has stood for so long is shown: a prompt, a progress."""


@dataclass(frozen=True)
class RawLine:
    """One line as its process wrote it, without its end."""

    data: bytes
    lost: int = 0
    """Bytes that were cut from its end."""


class LineAssembler:
    """The lines of one stream; at most `MAX_LINE_BYTES` and a chunk are ever held."""

    def __init__(self) -> None:
        self._rest = b""
        self._lost = 0
        self._rest_since = 0.0
        self._rewrites = False

    @property
    def unfinished(self) -> bool:
        """Whether there is a line that has not ended yet."""
        return bool(self._rest)

    def feed(self, chunk: bytes, now: float) -> list[RawLine]:
        """Take what was read at `now`, return the lines that it completes."""
        if not self._rest or not self._rewrites:
            self._rest_since = now
        lines = (self._rest + chunk).split(b"\n")
        self._rest = lines.pop()
        done = [self._finished(line) for line in lines]
        self._rewrites = b"\r" in self._rest
        if self._rewrites:
            self._rest = _newest_part(self._rest)
        if len(self._rest) > MAX_LINE_BYTES:
            self._lost += len(self._rest) - MAX_LINE_BYTES
            self._rest = self._rest[:MAX_LINE_BYTES]
        return done

    def flush(self, now: float, *, at_end: bool = False) -> list[RawLine]:
        """Return the unfinished line if it has stood for `IDLE_S`, or if the stream is `at_end`.

        What is written to it later comes as a line of its own.
        """
        if not self._rest or (now - self._rest_since < IDLE_S and not at_end):
            return []
        keep = 0 if at_end else _half_character(self._rest)
        line, self._rest = (
            self._rest[: len(self._rest) - keep],
            self._rest[len(self._rest) - keep :],
        )
        self._rest_since = now
        self._rewrites = False
        done = self._finished(line)
        return [done] if done.data else []

    def _finished(self, line: bytes) -> RawLine:
        lost, self._lost = self._lost, 0
        if b"\r" in line:
            line = _visible(line)
        if len(line) > MAX_LINE_BYTES:
            lost += len(line) - MAX_LINE_BYTES
            line = line[:MAX_LINE_BYTES]
        return RawLine(line, lost)


def _visible(line: bytes) -> bytes:
    """Return what a line that was rewritten by carriage returns shows in the end."""
    for part in reversed(line.split(b"\r")):
        if part:
            return part
    return b""


def _newest_part(rest: bytes) -> bytes:
    """Return the last rewriting and the one before it, in case the last is not complete."""
    last = rest.rfind(b"\r")
    before = rest.rfind(b"\r", 0, last)
    return rest[before + 1 :]


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
