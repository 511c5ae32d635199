"""Turns the bytes of a serial port into batches of frames in words, bounded for any input."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from robot.frames.lines import MOST, WAYS, FrameLine
from robot.frames.protocols import FrameKind, FramePhrases, noise
from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from robot.frames.protocols import FramePiece, FrameReader

GIVE_UP_S = 0.3
"""After this long, the rest of an incomplete frame is no longer expected."""
_PHRASES = {"frames": N_("{count} more"), "bytes": N_("{count} more bytes")}


class Chunk(NamedTuple):
    """Bytes as they were read or written."""

    time_s: float
    way: str
    octets: bytes


class FrameBatcher:
    """Collects frames, with one reader for each direction."""

    def __init__(self, make: Callable[[str], FrameReader], language: str) -> None:
        """`make` creates a reader for a language (en or ru)."""
        self._make, self._language = make, language
        self._words = FramePhrases(language, _PHRASES)
        self.restart()

    def restart(self) -> None:
        """Start again, anywhere in the stream."""
        self._readers = {way: self._make(self._language) for way in WAYS}
        self._heard_s = dict.fromkeys(WAYS, 0.0)
        self._fresh = set(WAYS)

    def tell(self, chunks: Iterable[Chunk], now_s: float, missed: int = 0) -> list[FrameLine]:
        """Return the frames that these bytes complete, at most `MOST`, and the number of others.

        `missed`: bytes that came after them but were not kept. Times are Unix seconds.
        """
        lines: list[FrameLine] = []
        more: Counter[str] = Counter()
        for chunk in chunks:
            self._heard_s[chunk.way] = chunk.time_s
            self._add(lines, more, chunk, self._read(chunk.way, chunk.octets))
        for way, reader in self._readers.items():
            if now_s - self._heard_s[way] > GIVE_UP_S:
                self._add(lines, more, Chunk(now_s, way, b""), reader.flush())
        lines += [self._mark(now_s, way, "frames", count) for way, count in more.items()]
        if missed:
            lines.append(self._mark(now_s, "in", "bytes", missed))
            self.restart()
        return lines

    def _read(self, way: str, octets: bytes) -> list[FramePiece]:
        pieces = self._readers[way].feed(octets)
        if pieces and way in self._fresh:
            self._fresh.discard(way)
            if pieces[0].kind is not FrameKind.FRAME:
                # Most likely the end of a frame whose beginning was missed.
                return pieces[1:]
        return pieces

    def _add(self, lines: list[FrameLine], more: Counter[str], chunk: Chunk, pieces: list[FramePiece]) -> None:
        for piece in pieces:
            last = lines[-1] if lines else None
            if last and piece.kind is FrameKind.NOISE is last.kind and last.way == chunk.way:
                octets = last.octets + piece.octets
                lines[-1] = replace(last, octets=octets, text=noise(octets, self._language).text)
            elif len(lines) >= MOST:
                more[chunk.way] += 1
            else:
                lines.append(FrameLine(chunk.time_s, chunk.way, piece.kind, piece.octets, piece.text))

    def _mark(self, time_s: float, way: str, key: str, count: int) -> FrameLine:
        said = self._words(key, count=count)
        return FrameLine(time_s, way, FrameKind.MORE, b"", said, count)
