"""Turns any message that holds a picture into the picture to show."""

from __future__ import annotations

from typing import TYPE_CHECKING

from graph.pictures.images import to_rgb
from graph.pictures.picture import COMPRESSED, Picture, numbers_picture, thinned
from graph.pictures.pixels import (
    BAYER,
    COLOURS,
    DEPTHS,
    YUV,
    UnknownEncodingError,
    image_fields,
    in_order,
    pixel_rows,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import Value
    from graph.pictures.picture import Fit


def read_picture(type_name: str, value: Mapping[str, Value], fit: Fit) -> Picture:
    """Return the picture of a `sensor_msgs/Image` or `CompressedImage`, thinned out to `fit`.

    Raises ImageError. A compressed picture takes milliseconds: do not call this where others wait.
    """
    if type_name == COMPRESSED:
        from graph.pictures.compressed import read_compressed

        return read_compressed(value, fit)
    (width, height, step), encoding, data = image_fields(value)
    if encoding in COLOURS:
        pixel_bytes, order = COLOURS[encoding]
        rows = pixel_rows(data, width, height, step, pixel_bytes)
        pixels = thinned(rows.reshape(height, width, pixel_bytes), fit)
        return Picture(in_order(pixels, order), width, height, encoding)
    if encoding in DEPTHS:
        kind = (">" if value.get("is_bigendian") else "<") + DEPTHS[encoding]
        size = int(kind[-1])
        rows = pixel_rows(data, width, height, step, size)
        every = rows.reshape(height, width, size)
        numbers = thinned(every, fit).copy().view(kind)[:, :, 0]
        return numbers_picture(numbers, width, height, encoding, lambda: every.copy().view(kind)[:, :, 0])
    if encoding in YUV or encoding in BAYER:
        return Picture(thinned(to_rgb(value), fit), width, height, encoding)
    raise UnknownEncodingError(encoding)
