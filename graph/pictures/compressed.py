"""`sensor_msgs/CompressedImage`: JPEG and PNG by OpenCV, refused before they can do harm."""

from __future__ import annotations

import re
import struct
from typing import TYPE_CHECKING, Any

from graph.pictures.picture import Picture, numbers_picture, thinned
from graph.pictures.pixels import ImageError, opencv
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from graph.data import Value
    from graph.pictures.picture import Fit

MOST_BYTES = 64 * 1024 * 1024
MOST_PIXELS = 64 * 1024 * 1024
"""Limit, because a few bytes of PNG can ask for terabytes."""
JPEG, PNG = b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n"
JPEG_END, PNG_END = b"\xff\xd9", b"IEND\xaeB`\x82"
DEPTH_HEAD = struct.Struct("<iff")
"""Header before the PNG of the transport compressedDepth: format, and two numbers for 32FC1."""
_FULL_SIZE = re.compile(r"; of (\d{1,5})x(\d{1,5})$")
"""What Deck's own relay adds to the format: the size of the camera's picture."""
_SIZED = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
"""JPEG segments that contain height and width (source: ITU T.81, table B.1)."""
_ALONE = frozenset({0x01, *range(0xD0, 0xD9)})
"""JPEG markers without a length."""


def read_compressed(value: Mapping[str, Value], fit: Fit) -> Picture:
    """Return the picture, decoded at the smallest size that suffices for `fit`.

    Raises ImageError: neither JPEG nor PNG, too large, cut short, damaged.
    """
    words, data = value.get("format"), value.get("data")
    if not isinstance(words, str) or not isinstance(data, (bytes, bytearray, memoryview)):
        raise ImageError(say("this is not a {type}", type="sensor_msgs/CompressedImage"))
    raw = bytes(data)
    head: tuple[int, float, float] | None = None
    if "compressedDepth" in words and len(raw) > DEPTH_HEAD.size:
        head, raw = DEPTH_HEAD.unpack_from(raw), raw[DEPTH_HEAD.size :]
    width, height = _size(raw)
    _refuse_if_cut(raw)
    pixels = _decoded(raw, _reduction(width, height, fit), as_they_are=head is not None)
    thin = thinned(pixels, fit)
    if head is not None:
        encoding, read = words.split(";")[0].strip(), head
        return numbers_picture(
            _depths(thin[..., 0], encoding, head),
            width,
            height,
            encoding,
            lambda: _depths(pixels[..., 0], encoding, read),
        )
    full = _FULL_SIZE.search(words)
    width, height = map(int, full.groups()) if full else (width, height)
    return Picture(thin[:, :, ::-1], width, height, "jpeg" if raw[:3] == JPEG else "png")


def _size(raw: bytes) -> tuple[int, int]:
    """Width and height according to the data, before anything is decoded."""
    if not raw:
        raise ImageError(say("the message has no data"))
    if len(raw) > MOST_BYTES:
        words = say("the data are too large: {found} bytes, at most {most}", found=len(raw), most=MOST_BYTES)
        raise ImageError(words)
    if raw.startswith(PNG):
        if len(raw) < 24:
            raise ImageError(say("the PNG data are cut short: {found} bytes", found=len(raw)))
        width, height = struct.unpack_from(">II", raw, 16)
    elif raw.startswith(JPEG):
        width, height = _jpeg_size(raw)
    else:
        words = say("the data are neither JPEG nor PNG: they begin with {first}", first=raw[:8].hex(" "))
        raise ImageError(words)
    if not 0 < width * height <= MOST_PIXELS:
        words = say(
            "an image of {width} x {height} is not decoded: it is too large or empty", width=width, height=height
        )
        raise ImageError(words)
    return width, height


def _jpeg_size(raw: bytes) -> tuple[int, int]:
    # Not with imagesize: it searches every byte of data that is not JPEG, half a minute for 64 MiB.
    at = 2
    while at + 9 <= len(raw):
        if raw[at] != 0xFF:
            break
        marker = raw[at + 1]
        if marker == 0xFF:
            at += 1
        elif marker in _ALONE:
            at += 2
        elif marker in _SIZED:
            height, width = struct.unpack_from(">HH", raw, at + 5)
            return width, height
        else:
            at += 2 + int.from_bytes(raw[at + 2 : at + 4], "big")
    raise ImageError(say("the JPEG data are damaged: they do not say how large the picture is"))


def _refuse_if_cut(raw: bytes) -> None:
    """Refuse what OpenCV would show only half of, with complaints on the terminal."""
    kind, end = ("JPEG", JPEG_END) if raw.startswith(JPEG) else ("PNG", PNG_END)
    if raw.rfind(end, -4096) < 0:
        words = say("the {kind} data are cut short: no end in {found} bytes", kind=kind, found=len(raw))
        raise ImageError(words)


def _reduction(width: int, height: int, fit: Fit) -> int:
    """How much the decoder may shrink it (1, 2, 4 or 8) without falling below the wanted pixels."""
    wide, high = fit(width, height)
    return next((by for by in (8, 4, 2) if width >= by * wide and height >= by * high), 1)


def _decoded(raw: bytes, reduction: int, *, as_they_are: bool) -> NDArray[np.uint8]:
    """Return pixels of shape (height, width, 3), or raw numbers of shape (height, width, 1)."""
    import numpy as np

    cv2 = opencv()
    modes: dict[int, int] = {
        1: cv2.IMREAD_COLOR,
        2: cv2.IMREAD_REDUCED_COLOR_2,
        4: cv2.IMREAD_REDUCED_COLOR_4,
        8: cv2.IMREAD_REDUCED_COLOR_8,
    }
    mode = cv2.IMREAD_UNCHANGED if as_they_are else modes[reduction]
    try:
        pixels: Any = cv2.imdecode(np.frombuffer(raw, np.uint8), mode)
    except cv2.error as error:
        raise ImageError(say("the data are damaged: {error}", error=error.err)) from error
    if pixels is None:
        kind = "JPEG" if raw.startswith(JPEG) else "PNG"
        words = say("the {kind} data are damaged: they cannot be decoded", kind=kind)
        raise ImageError(words)
    return pixels[:, :, None] if pixels.ndim == 2 else pixels  # type: ignore[no-any-return]


def _depths(numbers: NDArray[np.generic], encoding: str, head: tuple[int, float, float]) -> NDArray[np.generic]:
    """Return the numbers in the encoding; 32FC1 was sent as inverse depths.

    Source: compressed_depth_image_transport, codec.cpp.
    """
    if encoding != "32FC1":
        return numbers
    import numpy as np

    _format, scale, offset = head
    with np.errstate(divide="ignore", invalid="ignore"):
        depths: NDArray[np.generic] = np.where(numbers != 0, scale / (numbers.astype(np.float64) - offset), np.nan)
    return depths
