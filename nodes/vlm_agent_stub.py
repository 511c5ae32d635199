"""A placeholder for a vision model: keeps the newest picture, and "sends" it every 3 s.

The stream has 10 pictures a second, but a model is paid per picture: so the newest one is only
kept as it came, and decoded when needed. The JPEG that would be sent is really made; nothing leaves
this machine.
"""

from __future__ import annotations

from sensor_msgs.msg import Image

from nodes.parts.pictures import PictureTaker, jpeg_of
from nodes.parts.runner import run
from text.i18n import N_

_STARTED = N_("Waiting for pictures on {topic}")
_SENT = N_("Picture {width}x{height} -> JPEG of {size:.0f} kB, would go to the vision model now")
_NO_OPENCV = N_("Picture {width}x{height}; no JPEG without OpenCV: pip install opencv-python-headless")


class VlmAgentStub(PictureTaker):
    """Takes the newest picture at a low rate."""

    NAME = "vlm_agent"

    def __init__(self) -> None:
        super().__init__()
        self.say.info(_STARTED, topic=self.topic)

    def send(self, picture: Image) -> None:
        size = {"width": picture.width, "height": picture.height}
        try:
            jpeg = jpeg_of(picture, self.quality)
        except ImportError:
            self.say.warn(_NO_OPENCV, **size)
            return
        self.say.info(_SENT, size=len(jpeg) / 1000, **size)


if __name__ == "__main__":
    raise SystemExit(run(VlmAgentStub))
