"""Cuts the traffic of a serial line into frames and puts them in words, for a person who watches.

A reader gets the bytes of one direction in arbitrary pieces. What is not a valid frame is shown
too: a frame with a failed check as such, loose bytes as noise.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Protocol

from text.i18n import N_, localized
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping


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
