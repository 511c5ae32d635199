"""A simulated camera: publishes a small film with a counting caption, 10 pictures a second.

With `scene: room` it publishes the view of a camera on the simulated robot: it follows /mock/pose
of mock_robot, and turns with /head_state.

It replaces an Orbbec Gemini: same topic, same frame, `bgr8` as in the course or `rgb8` as the real
driver publishes it.
"""

from __future__ import annotations

import sys
from array import array

import numpy as np
from sensor_msgs.msg import Image

from nodes.parts.node import LessonNode, change_period
from nodes.parts.parameters import Choice, Number, Text, Whole
from nodes.parts.qos import NEWEST
from nodes.parts.runner import run
from nodes.simulated.room_scene import RoomScene
from nodes.simulated.scene import MovingScene
from robot.topics import CAMERA
from text.i18n import N_

FILM, ROOM = "film", "room"

_STARTED = N_("The camera publishes {width}x{height} {encoding}, {rate:g} pictures a second")


class MockCamera(LessonNode):
    """Publishes pictures of a scene."""

    NAME = "mock_camera"
    SETTINGS = (
        Choice("scene", FILM, "A film, or the room of mock_robot", choices=(FILM, ROOM), fixed=True),
        Text("topic", CAMERA, "Where the pictures are published", fixed=True),
        Number("rate", 10.0, "Pictures a second", low=0.1, high=120.0, unit="Hz"),
        Whole("width", 640, "Columns", low=16, high=4096, fixed=True),
        Whole("height", 480, "Rows", low=16, high=4096, fixed=True),
        Choice("encoding", "bgr8", "Order of colours", choices=("bgr8", "rgb8"), fixed=True),
        Text("frame_id", "camera_color_optical_frame", "Frame of the pictures", fixed=True),
    )

    def __init__(self) -> None:
        super().__init__()
        width, height = int(self.number("width")), int(self.number("height"))
        encoding = self.text("encoding")
        self._scene = self._make_scene(height, width, blue_first=encoding == "bgr8")
        self._message = Image(height=height, width=width, encoding=encoding, step=3 * width)
        self._message.header.frame_id = self.text("frame_id")
        self._message.data = array("B", bytes(height * width * 3))
        # The picture is drawn directly into the message.
        self._picture = np.frombuffer(self._message.data, np.uint8).reshape(height, width, 3)
        self._number = 0
        self._publisher = self.create_publisher(Image, self.text("topic"), NEWEST)
        self._timer = self.every(1.0 / self.number("rate"), self._tick)
        self.say.info(_STARTED, width=width, height=height, encoding=encoding, rate=self.number("rate"))

    def parameters_changed(self) -> None:
        """Apply the new rate."""
        change_period(self._timer, 1.0 / self.number("rate"))

    def _make_scene(self, height: int, width: int, *, blue_first: bool) -> MovingScene | RoomScene:
        if self.text("scene") == ROOM:
            return RoomScene(self, height, width, blue_first=blue_first)
        return MovingScene(height, width, blue_first=blue_first)

    def _tick(self) -> None:
        self._scene.draw(self._picture, self._number)
        self._message.header.stamp = self.get_clock().now().to_msg()
        self._publisher.publish(self._message)
        self._number += 1


def main(args: list[str] | None = None) -> int:
    """Run the node until it is asked to end."""
    return run(MockCamera, args)


if __name__ == "__main__":
    sys.exit(main())
