"""`sensor_msgs/CompressedImage`: JPEG and PNG by OpenCV, refused before they can do harm; and pictures packed so."""

from __future__ import annotations

import re
import struct
from typing import TYPE_CHECKING, Any

from graph.pictures.picture import METRES, Picture, numbers_picture, thinned
from graph.pictures.pixels import ImageError, opencv, pixels_of, to_rgb
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from graph.data import Value
    from graph.pictures.picture import Fit
    from graph.pictures.pixels import Rgb

MOST_BYTES = 64 * 1024 * 1024
MOST_PIXELS = 64 * 1024 * 1024
"""Limit, because a few bytes of PNG can ask for terabytes."""
JPEG, PNG = b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n"
JPEG_END, PNG_END = b"\xff\xd9", b"IEND\xaeB`\x82"
DEPTH_HEAD = struct.Struct("<iff")
"""Header before the PNG of the transport compressedDepth: format, and two numbers for 32FC1. Without these, the
numbers are millimetres (source: compressed_depth_image_transport, codec.cpp)."""
WIDTH, HEIGHT = 400, 300
"""At most, of a picture for a network: a terminal of 200 columns shows half of it, each pixel the mean of four."""
MILLIMETRES = 1000.0
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
    kind, end = ("JPEG", JPEG_END) if raw.startswith(JPEG) else ("PNG", PNG_END)
    if raw.rfind(end, -4096) < 0:
        # OpenCV would show half of it, with complaints on the terminal.
        raise ImageError(say("the {kind} data are cut short: no end in {found} bytes", kind=kind, found=len(raw)))
    pixels = _decoded(raw, kind, _reduction(width, height, fit), as_they_are=head is not None)
    if head is not None:
        encoding = words.split(";")[0].strip()
        every = _depths(pixels[..., 0], encoding, head)
        return numbers_picture(thinned(every, fit), (width, height), encoding, every)
    if full := _FULL_SIZE.search(words):
        width, height = map(int, full.groups())
    return Picture(thinned(pixels, fit)[:, :, ::-1], width, height, kind.lower())


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


def _reduction(width: int, height: int, fit: Fit) -> int:
    """How much the decoder may shrink it (1, 2, 4 or 8) without falling below the wanted pixels."""
    wide, high = fit(width, height)
    return next((by for by in (8, 4, 2) if width >= by * wide and height >= by * high), 1)


def _decoded(raw: bytes, kind: str, reduction: int, *, as_they_are: bool) -> NDArray[np.uint8]:
    """Return pixels of shape (height, width, 3), or raw numbers of shape (height, width, 1)."""
    import numpy as np

    cv2 = opencv()
    mode = getattr(cv2, f"IMREAD_REDUCED_COLOR_{reduction}" if reduction > 1 else "IMREAD_COLOR")
    mode = cv2.IMREAD_UNCHANGED if as_they_are else mode
    try:
        pixels: Any = cv2.imdecode(np.frombuffer(raw, np.uint8), mode)
    except cv2.error as error:
        raise ImageError(say("the data are damaged: {error}", error=error.err)) from error
    if pixels is None:
        raise ImageError(say("the {kind} data are damaged: they cannot be decoded", kind=kind))
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


def thinned_picture(value: Mapping[str, Value]) -> tuple[str, bytes]:
    """Return format and data of a `CompressedImage` from a `sensor_msgs/Image`: a few packets of a network.

    Colours become a JPEG, depths a PNG of millimetres; the format ends with the size of the image.
    Raises ImageError.
    """
    import numpy as np

    cv2 = opencv()
    encoding = value.get("encoding")
    pixels = pixels_of(value)[:, :, 0] if encoding in METRES else to_rgb(value)
    height, width = pixels.shape[:2]
    share = min(1.0, WIDTH / width, HEIGHT / height)
    size = max(1, round(width * share)), max(1, round(height * share))
    if encoding in METRES:
        metres = np.nan_to_num(pixels * METRES[str(encoding)], nan=0.0, posinf=0.0, neginf=0.0)
        depths = np.clip(metres * MILLIMETRES, 0, 65535).astype(np.uint16)
        # Not the mean: between near and far there is often nothing.
        _done, png = cv2.imencode(".png", cv2.resize(depths, size, interpolation=cv2.INTER_NEAREST))
        words, data = "16UC1; compressedDepth png", bytes(DEPTH_HEAD.size) + png.tobytes()
    else:
        small = cv2.resize(pixels, size, interpolation=cv2.INTER_AREA)
        words, data = f"{encoding}; jpeg compressed bgr8", to_jpeg(small, quality=70)
    return f"{words}; of {width}x{height}", data


def to_jpeg(rgb: Rgb, quality: int = 80) -> bytes:
    """Return a picture of shape (height, width, 3) as a JPEG file; `quality` is 0 to 100."""
    import cv2

    _done, data = cv2.imencode(".jpg", rgb[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])
    return data.tobytes()
