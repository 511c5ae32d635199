"""Raw pictures made small enough for a network that loses packets: a few packets each."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.pictures.images import to_rgb
from graph.pictures.jpeg import to_jpeg
from graph.pictures.picture import METRES
from graph.pictures.pixels import DEPTHS, image_fields, opencv, pixel_rows

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from graph.data import Value

WIDTH, HEIGHT = 400, 300
"""At most: a terminal of 200 columns shows half of it, each pixel the mean of four."""
QUALITY = 70
MILLIMETRES = 1000.0
DEPTH_HEAD = bytes(12)
"""Without a scale: the numbers are millimetres (source: compressed_depth_image_transport)."""


def thinned_picture(value: Mapping[str, Value]) -> tuple[str, bytes]:
    """Return format and data of a `CompressedImage` from a `sensor_msgs/Image`.

    Colours become a JPEG, depths a PNG of millimetres; the format ends with the size of the image.
    Raises ImageError.
    """
    (width, height, _step), encoding, _data = image_fields(value)
    share = min(1.0, WIDTH / max(1, width), HEIGHT / max(1, height))
    size = max(1, round(width * share)), max(1, round(height * share))
    cv2 = opencv()
    if encoding in METRES:
        # Not the mean: between near and far there is often nothing.
        depths = cv2.resize(_millimetres(value), size, interpolation=cv2.INTER_NEAREST)
        _done, png = cv2.imencode(".png", depths)
        words, data = "16UC1; compressedDepth png", DEPTH_HEAD + png.tobytes()
    else:
        small = cv2.resize(to_rgb(value), size, interpolation=cv2.INTER_AREA)
        words, data = f"{encoding}; jpeg compressed bgr8", to_jpeg(small, QUALITY)
    return f"{words}; of {width}x{height}", data


def _millimetres(value: Mapping[str, Value]) -> NDArray[np.uint16]:
    import numpy as np

    (width, height, step), encoding, data = image_fields(value)
    kind = (">" if value.get("is_bigendian") else "<") + DEPTHS[encoding]
    numbers = pixel_rows(data, width, height, step, int(kind[-1])).copy().view(kind)
    metres = np.nan_to_num(numbers * METRES[encoding], nan=0.0, posinf=0.0, neginf=0.0)
    depths: NDArray[np.uint16] = np.clip(metres * MILLIMETRES, 0, 65535).astype(np.uint16)
    return depths
