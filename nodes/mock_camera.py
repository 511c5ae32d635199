"""A simulated camera: publishes a small film with a counting caption, 10 pictures a second.

With `scene: room` it publishes the view of a camera on the simulated robot: it follows /mock/pose
of mock_robot, and turns with /head_state.

It replaces an Orbbec Gemini: same topic, same frame, `bgr8` as in the course or `rgb8` as the real
driver publishes it.
"""

from __future__ import annotations

from array import array

import numpy as np
from sensor_msgs.msg import Image

from nodes.parts.node import NEWEST, Choice, LessonNode, Number, Text, Whole, change_period
from nodes.parts.runner import run
from nodes.simulated.scenes import MovingScene, RoomScene
from robot.topics import CAMERA
from text.i18n import N_

FILM, ROOM = "film", "room"

_STARTED = N_("The camera publishes {width}x{height} {encoding}, {rate:g} pictures a second")


class MockCamera(LessonNode):
    """Publishes pictures of a scene."""

    NAME = "mock_camera"
    scene = Choice(FILM, "A film, or the room of mock_robot", choices=(FILM, ROOM), fixed=True)
    topic = Text(CAMERA, "Where the pictures are published", fixed=True)
    rate = Number(10.0, "Pictures a second", low=0.1, high=120.0, unit="Hz")
    width = Whole(640, "Columns", low=16, high=4096, fixed=True)
    height = Whole(480, "Rows", low=16, high=4096, fixed=True)
    encoding = Choice("bgr8", "Order of colours", choices=("bgr8", "rgb8"), fixed=True)
    frame_id = Text("camera_color_optical_frame", "Frame of the pictures", fixed=True)

    def __init__(self) -> None:
        super().__init__()
        width, height = self.width, self.height
        encoding = self.encoding
        self._scene = self._make_scene(height, width, blue_first=encoding == "bgr8")
        self._message = Image(height=height, width=width, encoding=encoding, step=3 * width)
        self._message.header.frame_id = self.frame_id
        self._message.data = array("B", bytes(height * width * 3))
        # The picture is drawn directly into the message.
        self._picture = np.frombuffer(self._message.data, np.uint8).reshape(height, width, 3)
        self._number = 0
        self._publisher = self.create_publisher(Image, self.topic, NEWEST)
        self._timer = self.every(1.0 / self.rate, self._tick)
        self.say.info(_STARTED, width=width, height=height, encoding=encoding, rate=self.rate)

    def parameters_changed(self) -> None:
        """Apply the new rate."""
        change_period(self._timer, 1.0 / self.rate)

    def _make_scene(self, height: int, width: int, *, blue_first: bool) -> MovingScene | RoomScene:
        if self.scene == ROOM:
            return RoomScene(self, height, width, blue_first=blue_first)
        return MovingScene(height, width, blue_first=blue_first)

    def _tick(self) -> None:
        self._scene.draw(self._picture, self._number)
        self._message.header.stamp = self.get_clock().now().to_msg()
        self._publisher.publish(self._message)
        self._number += 1


if __name__ == "__main__":
    raise SystemExit(run(MockCamera))
