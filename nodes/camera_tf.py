"""Where the camera is mounted on the robot: the static transform base_link -> camera_link.

Published once, latched, so that late subscribers get it, too. Metres forward, left and up, then
roll, pitch and yaw in radians (REP-103).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from nodes.parts.node import LATCHED, LessonNode, Number, Text
from nodes.parts.runner import run
from robot.topics import TF_STATIC
from space.transform import quaternion_from_rpy
from text.i18n import N_

_PUBLISHED = N_("{child} relative to {parent}: x {x:g}, y {y:g}, z {z:g} m")
_SAME = N_("parameters parent and child are both {parent}, but must differ")


def _metres(default: float, about: str) -> Number:
    return Number(default, about, low=-10.0, high=10.0, unit="m")


def _radians(about: str) -> Number:
    return Number(0.0, about, low=-math.pi, high=math.pi, unit="rad")


class CameraTf(LessonNode):
    """Publishes one transform, and again when a parameter changes."""

    NAME = "camera_tf"
    parent = Text("base_link", "The frame of the robot", fixed=True)
    child = Text("camera_link", "The frame of the camera", fixed=True)
    x = _metres(0.15, N_("Forward"))
    y = _metres(0.0, N_("To the left"))
    z = _metres(0.25, N_("Upwards"))
    roll = _radians(N_("About x"))
    pitch = _radians(N_("About y, + looks down"))
    yaw = _radians(N_("About z, + looks left"))

    def __init__(self) -> None:
        super().__init__()
        self._publisher = self.create_publisher(TFMessage, TF_STATIC, LATCHED)
        self._publish()

    def contradiction(self, values: Mapping[str, Any]) -> str | None:
        """Refuse a transform from a frame to itself."""
        return _SAME if values["parent"] == values["child"] else None

    def parameters_changed(self) -> None:
        """Publish the new place."""
        self._publish()

    def _publish(self) -> None:
        stamped = TransformStamped()
        stamped.header.stamp = self.get_clock().now().to_msg()
        stamped.header.frame_id = self.parent
        stamped.child_frame_id = self.child
        place, turn = stamped.transform.translation, stamped.transform.rotation
        place.x, place.y, place.z = self.x, self.y, self.z
        turn.x, turn.y, turn.z, turn.w = quaternion_from_rpy(self.roll, self.pitch, self.yaw)
        self._publisher.publish(TFMessage(transforms=[stamped]))
        self.say.info(_PUBLISHED, parent=self.parent, child=self.child, x=self.x, y=self.y, z=self.z)


if __name__ == "__main__":
    raise SystemExit(run(CameraTf))
