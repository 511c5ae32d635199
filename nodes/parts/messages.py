"""Pictures and sound in messages, to numpy and bytes, and back."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import Image
from std_msgs.msg import ByteMultiArray

from text.i18n import N_
from text.sentences import say

CHANNELS = 3
_BAD_ENCODING = N_("encoding {encoding}, but only bgr8 and rgb8 are understood")
_BAD_SIZE = N_("{width}x{height} pixels, {step} bytes a row and {size} bytes do not fit together")


class BadPictureError(ValueError):
    """A message that is not a valid picture; `phrase` and `values` say why."""

    def __init__(self, phrase: str, **values: object) -> None:
        super().__init__(say(phrase, **values))
        self.phrase = phrase
        self.values = values


def bgr(message: Image) -> NDArray[np.uint8]:
    """Return the picture as (rows, columns, 3), blue first; a view if possible.

    Raises `BadPictureError` for another encoding, or sizes that contradict each other.
    """
    if message.encoding not in ("bgr8", "rgb8"):
        raise BadPictureError(_BAD_ENCODING, encoding=message.encoding[:40] or '""')
    width, height, step = message.width, message.height, message.step
    row = width * CHANNELS
    if not width or not height or step < row or len(message.data) != step * height:
        raise BadPictureError(_BAD_SIZE, width=width, height=height, step=step, size=len(message.data))
    rows = np.frombuffer(message.data, np.uint8).reshape(height, step)
    picture = rows[:, :row].reshape(height, width, CHANNELS)
    return picture if message.encoding == "bgr8" else picture[:, :, ::-1]


def jpeg_of(message: Image, quality: int = 80) -> bytes:
    """Return the picture as a JPEG; `quality` is 1 to 100.

    Raises `BadPictureError` for a message that is not a valid picture, and ImportError without
    OpenCV.
    """
    picture = bgr(message)
    import cv2

    _made, jpeg = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])
    return jpeg.tobytes()


def fit(picture: NDArray[np.uint8], into: NDArray[np.uint8]) -> None:
    """Copy a picture into an array of (rows, columns, 3), blue first.

    One of another size is scaled, with black bars if the shape differs; grey ones are accepted too.
    """
    if picture.shape == into.shape:
        into[:] = picture
        return
    import cv2

    rows, columns = picture.shape[:2]
    scale = min(into.shape[0] / rows, into.shape[1] / columns)
    height, width = max(1, round(rows * scale)), max(1, round(columns * scale))
    top, left = (into.shape[0] - height) // 2, (into.shape[1] - width) // 2
    scaled = cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA)
    into[:] = 0
    into[top : top + height, left : left + width] = scaled.reshape(height, width, -1)


def sound_message(sound: bytes) -> ByteMultiArray:
    """Return samples (signed, 16 bit, little-endian, mono) as ROS wants them: each byte a bytes of its own."""
    return ByteMultiArray(data=[sound[at : at + 1] for at in range(len(sound))])


def sound_of(message: ByteMultiArray) -> bytes:
    """Return the samples of a message, as `sound_message` takes them."""
    return b"".join(message.data)
