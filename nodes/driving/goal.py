"""One active goal of `drive_to_point`: its state and its end."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

from deck_interfaces.action import DriveToPoint
from rclpy.task import Future

from robot.motion.approach import ApproachProgress

if TYPE_CHECKING:
    from rclpy.action.server import ServerGoalHandle

    from robot.motion.approach import Approach
    from robot.motion.odometry import Pose

_FEEDBACK_EVERY_S = 0.2


class DriveGoal:
    """A goal that has been accepted."""

    def __init__(self, handle: ServerGoalHandle, approach: Approach, patience_s: float) -> None:
        self.handle = handle
        self.approach = approach
        self.over = Future()
        """The future of the action's result."""
        self._patience_s = patience_s
        self._progress: ApproachProgress | None = None
        self._began_s = time.monotonic()
        self._told_s = 0.0

    @property
    def age_s(self) -> float:
        """Return the seconds since it was accepted."""
        return time.monotonic() - self._began_s

    def distance_m(self, pose: Pose | None) -> float:
        """Return the metres still to go; nan if the robot's position is unknown."""
        return math.nan if pose is None else pose.distance_to(self.approach.goal)

    def watch(self, pose: Pose) -> ApproachProgress:
        """Return its progress, including the newest pose."""
        now_s = time.monotonic()
        if self._progress is None:
            longest_m = self.approach.longest_way_m(pose)
            self._progress = ApproachProgress(longest_m, self._patience_s, pose, now_s)
        self._progress.take(pose, now_s)
        return self._progress

    def tell(self, pose: Pose) -> None:
        """Send the distance as feedback, at a limited rate."""
        now_s = time.monotonic()
        if now_s - self._told_s >= _FEEDBACK_EVERY_S:
            self._told_s = now_s
            self.handle.publish_feedback(DriveToPoint.Feedback(distance=self.distance_m(pose)))

    def finish(self, reached: bool, pose: Pose | None, message: str) -> None:
        """End it: reached, or else cancelled if requested, or else aborted."""
        if reached:
            self.handle.succeed()
        elif self.handle.is_cancel_requested:
            self.handle.canceled()
        else:
            self.handle.abort()
        distance_m = self.distance_m(pose)
        self.over.set_result(DriveToPoint.Result(reached=reached, distance=distance_m, message=message))
