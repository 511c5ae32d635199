"""A camera that pans over a landscape, 640x480 at 15 Hz: nearly every cell changes each time."""

from __future__ import annotations

import numpy as np
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Image

WIDTH, HEIGHT, RATE_HZ = 640, 480, 15.0
HILL = 24
"""Pixels from one hill to the next."""
STEP = 40
"""Pixels from one picture to the next."""
TOPIC = "/camera/color/image_raw"
PROFILE = """\
title: {{en: A camera that pans}}
nodes:
  camera: {{exec: [{python}, -m, tests.e2e.panning_camera], cwd: {root}, ready: {{topic: {topic}}}}}
panels: [camera]
"""


class PanningCamera(Node):
    """Publishes one window of the landscape after the other."""

    def __init__(self) -> None:
        super().__init__("camera")
        hills = np.random.default_rng(1).integers(0, 256, (HEIGHT // HILL, 100, 3), np.uint8)
        self._land = hills.repeat(HILL, axis=0).repeat(HILL, axis=1)
        self._left = 0
        self._publisher = self.create_publisher(Image, TOPIC, 1)
        self.create_timer(1 / RATE_HZ, self._publish)

    def _publish(self) -> None:
        window = np.roll(self._land, -self._left, axis=1)[:, :WIDTH]
        self._left += STEP
        message = Image(height=HEIGHT, width=WIDTH, encoding="rgb8", step=3 * WIDTH)
        message.data.frombytes(window.tobytes())
        self._publisher.publish(message)


if __name__ == "__main__":
    rclpy.init()
    rclpy.spin(PanningCamera())
