"""What the encodings of sensor_msgs/Image mean: depth, number of channels, order of colours."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache

DEPTHS = {
    "8U": "uint8",
    "8S": "int8",
    "16U": "uint16",
    "16S": "int16",
    "32S": "int32",
    "32F": "float32",
    "64F": "float64",
}
"""The name of a depth in an encoding, and numpy's name for it."""

DEPTH_NAMES = {numpy: name for name, numpy in DEPTHS.items()}

_GENERIC = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)C([1-9][0-9]*)?")
_COLOURS = re.compile(r"(mono|bgra|rgba|bgr|rgb)(8|16)")
_BAYER = re.compile(r"bayer_(rggb|bggr|gbrg|grbg)(8|16)")
_YUV = {"yuv422": "uyvy", "uyvy": "uyvy", "yuv422_yuy2": "yuyv", "yuyv": "yuyv"}
_CHANNELS = {"mono": 1, "bgr": 3, "rgb": 3, "bgra": 4, "rgba": 4}


@dataclass(frozen=True)
class Encoding:
    """An encoding taken apart; `colours` is empty if it says nothing about colours."""

    name: str
    depth: str
    channels: int
    colours: str

    @property
    def generic(self) -> str:
        """The same depth and channels as OpenCV names them: 8UC3."""
        return f"{self.depth}C{self.channels}"

    @property
    def dtype(self) -> str:
        """The name of numpy's type of one value."""
        return DEPTHS[self.depth]

    @property
    def is_raw(self) -> bool:
        """Whether the colours can be read from it but not written to it."""
        return self.colours in {"uyvy", "yuyv", "rggb", "bggr", "gbrg", "grbg"}


@cache
def encoding(name: str) -> Encoding | None:
    """Return what an encoding means, None if there is none of that name."""
    if found := _GENERIC.fullmatch(name):
        return Encoding(name, found[1], int(found[2] or 1), "")
    if found := _COLOURS.fullmatch(name):
        return Encoding(name, f"{found[2]}U", _CHANNELS[found[1]], found[1])
    if found := _BAYER.fullmatch(name):
        return Encoding(name, f"{found[2]}U", 1, found[1])
    if name in _YUV:
        return Encoding(name, "8U", 2, _YUV[name])
    return None
