"""Where the camera is mounted on the robot: the static transform base_link -> camera_link.

Published once, latched, so that late subscribers get it, too. Metres forward, left and up, then
roll, pitch and yaw in radians (REP-103).
"""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING

from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from nodes.parts.node import LessonNode
from nodes.parts.parameters import Number, Text, Value
from nodes.parts.qos import LATCHED
from nodes.parts.runner import run
from robot.topics import TF_STATIC
from space.transform import quaternion_from_rpy
from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Mapping

_PUBLISHED = N_("{child} relative to {parent}: x {x:g}, y {y:g}, z {z:g} m")
_SAME = N_("parameters parent and child are both {parent}, but must differ")


def _metres(name: str, default: float, about: str) -> Number:
    return Number(name, default, about, low=-10.0, high=10.0, unit="m")


def _radians(name: str, about: str) -> Number:
    return Number(name, 0.0, about, low=-math.pi, high=math.pi, unit="rad")


class CameraTf(LessonNode):
    """Publishes one transform, and again when a parameter changes."""

    NAME = "camera_tf"
    SETTINGS = (
        Text("parent", "base_link", "The frame of the robot", fixed=True),
        Text("child", "camera_link", "The frame of the camera", fixed=True),
        _metres("x", 0.15, N_("Forward")),
        _metres("y", 0.0, N_("To the left")),
        _metres("z", 0.25, N_("Upwards")),
        _radians("roll", N_("About x")),
        _radians("pitch", N_("About y, + looks down")),
        _radians("yaw", N_("About z, + looks left")),
    )

    def __init__(self) -> None:
        super().__init__()
        self._publisher = self.create_publisher(TFMessage, TF_STATIC, LATCHED)
        self._publish()

    def contradiction(self, values: Mapping[str, Value]) -> str | None:
        """Refuse a transform from a frame to itself."""
        return _SAME if values["parent"] == values["child"] else None

    def parameters_changed(self) -> None:
        """Publish the new place."""
        self._publish()

    def _publish(self) -> None:
        stamped = TransformStamped()
        stamped.header.stamp = self.get_clock().now().to_msg()
        stamped.header.frame_id = self.text("parent")
        stamped.child_frame_id = self.text("child")
        x, y, z = (self.number(axis) for axis in "xyz")
        place, turn = stamped.transform.translation, stamped.transform.rotation
        place.x, place.y, place.z = x, y, z
        angles = (self.number(name) for name in ("roll", "pitch", "yaw"))
        turn.x, turn.y, turn.z, turn.w = quaternion_from_rpy(*angles)
        self._publisher.publish(TFMessage(transforms=[stamped]))
        self.say.info(_PUBLISHED, parent=self.text("parent"), child=self.text("child"), x=x, y=y, z=z)


def main(args: list[str] | None = None) -> int:
    """Run the node until it is asked to end."""
    return run(CameraTf, args)


if __name__ == "__main__":
    sys.exit(main())
