"""Pictures: sensor_msgs/Image to numpy, without cv_bridge, and a node that looks at the newest now and then."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import Image

from nodes.parts.node import LessonNode, Number, PhrasedError, SensorListener, Text, Whole, change_period
from robot.topics import CAMERA
from text.i18n import N_

CHANNELS = 3
_NONE = N_("No picture yet on {topic}")
_OLD = N_("No new picture on {topic} since the last one")
_BAD = N_("The picture is refused: {reason}")
_BAD_ENCODING = N_("encoding {encoding}, but only bgr8 and rgb8 are understood")
_BAD_SIZE = N_("{width}x{height} pixels, {step} bytes a row and {size} bytes do not fit together")


class BadPictureError(PhrasedError, ValueError):
    """A message that is not a valid picture."""


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


class PictureTaker(LessonNode):
    """Keeps the newest picture, and has it sent each `period`; none is ever queued."""

    topic = Text(CAMERA, "Where the pictures come from", fixed=True)
    period = Number(3.0, "Time between two looks", low=0.1, high=3600.0, unit="s")
    quality = Whole(80, "Quality of the JPEG", low=1, high=100)

    def __init__(self) -> None:
        super().__init__()
        self._newest: bytes | None = None
        """Serialized: decoding ten pictures a second to use one in thirty would be wasteful."""
        self._any = False
        SensorListener(self, Image, self.topic, self._keep, depth=1, raw=True)
        self._timer = self.every(self.period, self._look)

    def send(self, picture: Image) -> None:
        """Send the picture somewhere; raises `BadPictureError`."""
        raise NotImplementedError

    @property
    def is_ready(self) -> bool:
        """Whether a picture can be sent now."""
        return True

    def parameters_changed(self) -> None:
        """Apply the new period."""
        change_period(self._timer, self.period)

    def _keep(self, serialized: bytes) -> None:
        self._newest, self._any = serialized, True

    def _look(self) -> None:
        if not self.is_ready:
            return
        if self._newest is None:
            self.say.warn(_OLD if self._any else _NONE, every_s=1.0, topic=self.topic)
            return
        picture, self._newest = deserialize_message(self._newest, Image), None
        try:
            self.send(picture)
        except BadPictureError as error:
            self.say.warn(_BAD, reason=self.say.text(error.phrase, **error.values))
