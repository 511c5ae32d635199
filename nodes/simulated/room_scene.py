"""The simulated camera's view of the room around the simulated robot."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState

from nodes.parts.qos import DEPTH
from robot.joints import HEAD_PAN, HEAD_TILT
from robot.motion.odometry import Pose, yaw_from_quaternion
from robot.topics import HEAD_STATE, MOCK_POSE
from robot.world.room import LIVING_ROOM
from robot.world.view import CameraPose, RoomView
from text.i18n import N_

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from nodes.parts.node import LessonNode

_PATIENCE_S = 3.0
_NO_POSE = N_("Nobody publishes {topic}: the picture is that of the start (is mock_robot running?)")


class RoomScene:
    """Follows the true pose of the robot, and the head that the camera sits on."""

    def __init__(self, node: LessonNode, height: int, width: int, *, blue_first: bool) -> None:
        self._say = node.say
        self._view = RoomView(LIVING_ROOM, height, width, blue_first=blue_first)
        self._pose, self._pan_rad, self._tilt_rad = Pose(), 0.0, 0.0
        self._drawn: CameraPose | None = None
        self._waits_since_s: float | None = time.monotonic()
        node.create_subscription(PoseStamped, MOCK_POSE, self._take_pose, DEPTH)
        node.create_subscription(JointState, HEAD_STATE, self._take_head, DEPTH)

    def draw(self, picture: NDArray[np.uint8], _number: int) -> None:
        """Draw into an array of shape (height, width, 3), always the same one."""
        since_s = self._waits_since_s
        if since_s is not None and time.monotonic() - since_s > _PATIENCE_S:
            self._say.warn(_NO_POSE, every_s=30.0, topic=MOCK_POSE)
        eye = CameraPose.on(self._pose, self._pan_rad, self._tilt_rad)
        if eye != self._drawn:
            # A standing robot keeps its picture.
            self._view.draw(picture, eye)
            self._drawn = eye

    def _take_pose(self, message: PoseStamped) -> None:
        place, turn = message.pose.position, message.pose.orientation
        pose = Pose(place.x, place.y, yaw_from_quaternion(turn.x, turn.y, turn.z, turn.w))
        if pose.is_finite:
            self._pose, self._waits_since_s = pose, None

    def _take_head(self, message: JointState) -> None:
        angles = dict(zip(message.name, message.position, strict=False))
        # A head with an unknown direction counts as looking straight ahead.
        looks = angles.get(HEAD_PAN, 0.0), angles.get(HEAD_TILT, 0.0)
        if all(map(math.isfinite, looks)):
            self._pan_rad, self._tilt_rad = looks
