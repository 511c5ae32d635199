"""A picture as a JPEG file, for programs that take pictures as files."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from graph.pictures.pixels import Rgb


def to_jpeg(rgb: Rgb, quality: int = 80) -> bytes:
    """Return a picture of shape (height, width, 3) as a JPEG file; `quality` is 0 to 100."""
    import cv2

    _done, data = cv2.imencode(".jpg", rgb[:, :, ::-1], [cv2.IMWRITE_JPEG_QUALITY, quality])
    return data.tobytes()
