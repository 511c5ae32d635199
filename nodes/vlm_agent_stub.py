"""A placeholder for a vision model: keeps the newest picture, and "sends" it every 3 s.

The stream has 10 pictures a second, but a model is paid per picture: so the newest one is only
kept as it came, and decoded when needed. The JPEG that would be sent is really made; nothing leaves
this machine.
"""

from __future__ import annotations

from rclpy.serialization import deserialize_message
from sensor_msgs.msg import Image

from nodes.parts.listeners import SensorListener
from nodes.parts.messages import BadPictureError, jpeg_of
from nodes.parts.node import LessonNode, Number, Text, Whole, change_period
from robot.topics import CAMERA
from text.i18n import N_

_STARTED = N_("Waiting for pictures on {topic}")
_NONE = N_("No picture yet on {topic}")
_OLD = N_("No new picture on {topic} since the last one")
_SENT = N_("Picture {width}x{height} -> JPEG of {size:.0f} kB, would go to the vision model now")
_BAD = N_("The picture is refused: {reason}")
_NO_OPENCV = N_("Picture {width}x{height}; no JPEG without OpenCV: pip install opencv-python-headless")


class VlmAgentStub(LessonNode):
    """Takes the newest picture at a low rate."""

    NAME = "vlm_agent"
    topic = Text(CAMERA, "Where the pictures come from", fixed=True)
    period = Number(3.0, "Time between two looks", low=0.1, high=3600.0, unit="s")
    quality = Whole(80, "Quality of the JPEG", low=1, high=100)

    def __init__(self) -> None:
        super().__init__()
        self._newest: bytes | None = None
        """Serialized: decoding ten pictures a second to use one in thirty would be wasteful."""
        self._any = False
        topic = self.topic
        SensorListener(self, Image, topic, self._keep, depth=1, raw=True)
        self._timer = self.every(self.period, self._look)
        self.say.info(_STARTED, topic=topic)

    def parameters_changed(self) -> None:
        """Apply the new period."""
        change_period(self._timer, self.period)

    def _keep(self, serialized: bytes) -> None:
        self._newest = serialized
        self._any = True

    def _look(self) -> None:
        if self._newest is None:
            self.say.warn(_OLD if self._any else _NONE, topic=self.topic)
            return
        message, self._newest = deserialize_message(self._newest, Image), None
        try:
            self._send(message)
        except BadPictureError as error:
            self.say.warn(_BAD, reason=self.say.text(error.phrase, **error.values))

    def _send(self, message: Image) -> None:
        size = {"width": message.width, "height": message.height}
        try:
            jpeg = jpeg_of(message, self.quality)
        except ImportError:
            self.say.warn(_NO_OPENCV, **size)
            return
        self.say.info(_SENT, size=len(jpeg) / 1000, **size)


if __name__ == "__main__":
    raise SystemExit(VlmAgentStub.main())
