"""Any message that holds a picture, as a picture of the size that is shown."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.heavy_types import COMPRESSED_IMAGE
from graph.pictures.compressed import read_compressed
from graph.pictures.picture import Picture, numbers_picture, thinned
from graph.pictures.pixels import DEPTHS, coloured, pixels_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import Value
    from graph.pictures.picture import Fit


def read_picture(type_name: str, value: Mapping[str, Value], fit: Fit) -> Picture:
    """Return the picture of a `sensor_msgs/Image` or `CompressedImage`, thinned out to `fit`.

    Raises ImageError. A compressed picture takes milliseconds: do not call this where others wait.
    """
    if type_name == COMPRESSED_IMAGE:
        return read_compressed(value, fit)
    pixels, encoding = pixels_of(value), str(value["encoding"])
    height, width = pixels.shape[:2]
    thin = thinned(pixels, fit)
    if encoding in DEPTHS:
        return numbers_picture(thin[:, :, 0], (width, height), encoding, pixels[:, :, 0])
    return Picture(coloured(thin, encoding), width, height, encoding)
