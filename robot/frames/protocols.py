"""Cuts the traffic of a serial line into frames and puts them in words, for a person who watches.

A reader gets the bytes of one direction in arbitrary pieces. What is not a valid frame is shown
too: a frame with a failed check as such, loose bytes as noise.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import NamedTuple, Protocol

from text.i18n import N_, localized
from text.nested import read_json
from text.sentences import say


class FrameKind(str, Enum):
    """The kind of a piece of a stream."""

    FRAME = "frame"
    BAD = "bad"
    """It looks like a frame, but its check or its content is wrong."""
    NOISE = "noise"
    """Bytes that belong to no frame."""
    MORE = "more"
    """A marker: frames that are counted, not shown."""


@dataclass(frozen=True)
class FramePiece:
    """Some bytes of a stream, and their meaning in one line."""

    octets: bytes
    text: str
    kind: FrameKind = FrameKind.FRAME


class FrameReader(Protocol):
    """Cuts one direction of a serial line into pieces; buffers less than one frame."""

    def feed(self, data: bytes) -> list[FramePiece]:
        """The pieces that these bytes complete, oldest first."""

    def flush(self) -> list[FramePiece]:
        """What is left of a frame that nobody goes on with."""


class FramePhrases:
    """Phrases of one language."""

    def __init__(self, language: str, phrases: Mapping[str, str]) -> None:
        """`phrases`: key to English, for `str.format`; `language` is en or ru."""
        self._language, self._phrases = language, phrases

    def __call__(self, key: str, **values: object) -> str:
        return localized(say(self._phrases[key], **values), self._language)


_NOISE = {"one": N_("noise 1 byte"), "many": N_("noise {count} bytes")}


def noise(octets: bytes, language: str) -> FramePiece:
    """Bytes that belong to no frame."""
    key = "one" if len(octets) == 1 else "many"
    return FramePiece(octets, FramePhrases(language, _NOISE)(key, count=len(octets)), FrameKind.NOISE)


_ENOUGH = 4
"""Bytes from which the length of a frame can be read."""


class HeadedReader:
    """Reads frames that begin with a two-byte header."""

    def __init__(
        self, language: str, head: bytes, length: Callable[[bytes], int], piece: Callable[[bytes], FramePiece]
    ) -> None:
        """`length`: the length of a frame that begins like this, 0 if not known yet.

        It is the length of the header alone if no frame begins like this. `piece` describes that
        many bytes: as a frame or, if they are not one, what is wrong with them.
        """
        self._language, self._head, self._length, self._piece = language, head, length, piece
        self._rest = b""

    def feed(self, data: bytes) -> list[FramePiece]:
        """The pieces that these bytes complete, oldest first."""
        stream, at = self._rest + data, 0
        found: list[FramePiece] = []
        while True:
            start = _find(stream, self._head, at)
            if start > at:
                found.append(noise(stream[at:start], self._language))
            size = self._length(stream[start : start + _ENOUGH])
            if not size or len(stream) - start < size:
                break
            found.append(self._at(stream, start, size))
            at = start + len(found[-1].octets)
        self._rest = stream[start:]
        return found

    def flush(self) -> list[FramePiece]:
        """What is left of a frame that nobody goes on with."""
        rest, self._rest = self._rest, b""
        return [noise(rest, self._language)] if rest else []

    def _at(self, stream: bytes, start: int, size: int) -> FramePiece:
        piece = self._piece(stream[start : start + size])
        if piece.kind is FrameKind.FRAME:
            return piece
        # With a header inside, the frame has lost its end, and the next one may be whole.
        inner = stream.find(self._head, start + 1, start + size + 1)
        if inner >= 0 or size <= len(self._head):
            return noise(stream[start : inner if inner >= 0 else start + size], self._language)
        return piece


def _find(stream: bytes, head: bytes, at: int) -> int:
    """Return where the next header begins, or may begin; the end if there is none."""
    found = stream.find(head, at)
    if found >= 0:
        return found
    return len(stream) - (len(stream) > at and stream.endswith(head[:1]))


class RawReader:
    """Shows bytes as they come, if their meaning is unknown."""

    _PHRASES = {"raw": N_("bytes: {count}")}  # noqa: RUF012

    def __init__(self, language: str) -> None:
        self._words = FramePhrases(language, self._PHRASES)

    def feed(self, data: bytes) -> list[FramePiece]:
        return [FramePiece(data, self._words("raw", count=len(data)))] if data else []

    def flush(self) -> list[FramePiece]:
        """Return nothing: nothing is buffered."""
        return []


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
    """Encode a batch as drivers publish it on `~/frames`: one line of JSON per frame.

    `{"t": 1700000000.123, "way": "in", "kind": "frame", "hex": "5959...", "text": "distance 1.23 m"}`
    with the time in Unix seconds. A batch has at most `MOST` frames; a last line of kind `more` says
    how many more there were.
    """
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


GIVE_UP_S = 0.3
"""After this long, the rest of an incomplete frame is no longer expected."""
_MORE = {"frames": N_("{count} more"), "bytes": N_("{count} more bytes")}


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
        self._words = FramePhrases(language, _MORE)
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
