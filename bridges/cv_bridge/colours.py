"""From one encoding to another: the order of colours first, then the depth."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from cv_bridge.encodings import Encoding, encoding

Picture = npt.NDArray[Any]

# OpenCV names a Bayer pattern by its second row, ROS by its first.
_TO_BGR = {
    "rggb": cv2.COLOR_BayerBG2BGR,
    "bggr": cv2.COLOR_BayerRG2BGR,
    "gbrg": cv2.COLOR_BayerGR2BGR,
    "grbg": cv2.COLOR_BayerGB2BGR,
    "uyvy": cv2.COLOR_YUV2BGR_UYVY,
    "yuyv": cv2.COLOR_YUV2BGR_YUY2,
}


_FACTORS = {("8", "16"): 65535 / 255, ("16", "8"): 255 / 65535}
"""From bits to bits: white stays white."""


class CvBridgeError(TypeError):
    """An image cannot be converted."""


def known(name: str) -> Encoding:
    """Return what an encoding means; raise CvBridgeError if there is none of that name."""
    found = encoding(name)
    if found is None:
        raise CvBridgeError(f"Unrecognized image encoding [{name}]")
    return found


def convert(picture: Picture, source: str, target: str) -> Picture:
    """Return a picture of one encoding in another."""
    if source == target:
        return picture
    before, after = known(source), known(target)
    if not before.colours and after.colours:
        raise CvBridgeError(
            f"[{source}] is not a color format. but [{target}] is. The conversion does not make sense"
        )
    if before.colours and after.colours and before.colours != after.colours:
        picture = _recolour(picture, before, after)
    elif before.channels != after.channels:
        raise CvBridgeError(f"[{source}] and [{target}] do not have the same number of channels")
    return _rescale(picture, before, after)


def _recolour(picture: Picture, before: Encoding, after: Encoding) -> Picture:
    if after.is_raw:
        raise CvBridgeError(f"Unsupported conversion from [{before.name}] to [{after.name}]")
    colours = before.colours
    if before.is_raw:
        picture = np.asarray(cv2.cvtColor(picture, _TO_BGR[colours]))
        colours = "bgr"
    if colours == after.colours:
        return picture
    names = {"mono": "GRAY"}
    left, right = (names.get(each, each.upper()) for each in (colours, after.colours))
    return np.asarray(cv2.cvtColor(picture, getattr(cv2, f"COLOR_{left}2{right}")))


def _rescale(picture: Picture, before: Encoding, after: Encoding) -> Picture:
    """Change the depth."""
    if before.depth == after.depth:
        return picture
    factor = _FACTORS.get((before.depth[:-1], after.depth[:-1]), 1.0)
    if after.depth.endswith("F"):
        return (picture * factor).astype(after.dtype)
    limits = np.iinfo(after.dtype)
    # As OpenCV does: what does not fit becomes the nearest that does.
    return np.clip(np.rint(picture * factor), limits.min, limits.max).astype(after.dtype)
