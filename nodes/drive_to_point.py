"""The action of lesson 3: drives to a point in the odom frame, reports progress, can be cancelled.

It reads /odom and publishes /drive `rate` times a second while it has a goal, and a stop at the
end. `robot.motion.approach` finds the way: forward, in reverse for a point close behind, and
backing away first from a point inside the turning circle. A drive is aborted, with the reason in
the result's message, at an emergency stop, if odometry is missing or too old, if the robot stands
although it should drive, and if it drives but does not arrive. A new goal replaces the old one. A
goal that is not a number or too far away is refused; so is any goal during an emergency stop.

/goal_pose is the current goal, latched; a pose without a frame means that there is none.

With `simulate: auto` a simulated base publishes /odom and /tf if nobody else does.
"""

from __future__ import annotations

import math
import sys
import time
from typing import TYPE_CHECKING

from ackermann_msgs.msg import AckermannDriveStamped
from deck_interfaces.action import DriveToPoint
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration

from nodes.driving import words
from nodes.driving.goal import DriveGoal
from nodes.driving.goal_pose import GoalPose
from nodes.parts.drive import to_message
from nodes.parts.emergency import EmergencyStopListener
from nodes.parts.node import LessonNode, change_period
from nodes.parts.odometry import OdometryListener
from nodes.parts.parameters import Choice, Number, Text
from nodes.parts.qos import DEPTH
from nodes.parts.runner import run
from nodes.simulated.base import ALWAYS, AUTO, NEVER, WAIT_S, SimulatedBase
from robot.kinematics import WHEELBASE_M
from robot.limits import SPEED, STEERING
from robot.motion.approach import Approach, ApproachLimits
from robot.motion.odometry import Point, Pose
from robot.topics import DRIVE, DRIVE_TO_POINT, ODOMETRY
from robot.words import STOP

if TYPE_CHECKING:
    from rclpy.action.server import ServerGoalHandle
    from rclpy.task import Future

    from robot.words import DriveSetpoint

_FINEST_M, _COARSEST_M = 0.02, 2.0
_NO_ODOMETRY_S = WAIT_S + 1.0
"""How long a goal waits for a first pose."""
_LAST_STOP = Duration(seconds=0.2)
"""How long the last stop may take to reach all subscribers."""
_LAST_WORD_S = 0.2
"""How long the result may take to reach its clients."""


class DriveToPointNode(LessonNode):
    """Drives to one point at a time."""

    NAME = "drive_to_point"
    SETTINGS = (
        Choice(
            "simulate",
            AUTO,
            "A simulated base publishes /odom; auto: if nobody else does",
            fixed=True,
            choices=(AUTO, ALWAYS, NEVER),
        ),
        Text("base_topic", DRIVE, "Commands that the simulated base obeys", fixed=True),
        Number("max_speed", 0.3, "Maximum speed", low=0.05, high=SPEED.high, unit="m/s"),
        Number("max_steering", 0.5, "Maximum steering angle", low=0.1, high=STEERING.high, unit="rad"),
        Number("wheelbase", WHEELBASE_M, "Between front and rear axle", fixed=True, low=0.02, high=10.0, unit="m"),
        Number(
            "tolerance", 0.1, "Tolerance for a goal that sets none (0)", low=_FINEST_M, high=_COARSEST_M, unit="m"
        ),
        Number("max_distance", 20.0, "A farther goal is refused", low=0.1, high=1000.0, unit="m"),
        Number("rate", 20.0, "Commands a second while driving", low=5.0, high=100.0, unit="Hz"),
        Number("stale_after_s", 1.0, "A longer silence of /odom ends a drive", low=0.1, high=60.0, unit="s"),
        Number("patience_s", 5.0, "Standing longer than this ends a drive", low=0.5, high=600.0, unit="s"),
    )

    def __init__(self) -> None:
        super().__init__()
        self._goal: DriveGoal | None = None
        self._waiting: dict[bytes, Future] = {}
        """Goals whose results have not been sent to their clients yet."""
        self._publisher = self.create_publisher(AckermannDriveStamped, DRIVE, DEPTH)
        self._goal_pose = GoalPose(self)
        self._emergency = EmergencyStopListener(self, self._emergency_changed)
        self._odometry = OdometryListener(self)
        self._base = SimulatedBase(
            self,
            self.text("simulate"),
            self.text("base_topic"),
            self.number("wheelbase"),
            held=lambda: self._emergency.active,
        )
        self._timer = self.every(1.0 / self.number("rate"), self._tick)
        self._timer.cancel()
        # A goal's callback waits for its end: it must not block the timer's callback group.
        self._server = ActionServer(
            self,
            DriveToPoint,
            DRIVE_TO_POINT,
            self._execute,
            callback_group=ReentrantCallbackGroup(),
            goal_callback=self._judge,
            handle_accepted_callback=self._begin,
            cancel_callback=lambda _handle: CancelResponse.ACCEPT,
        )
        self.say.info(words.STARTED, action=DRIVE_TO_POINT)

    def parameters_changed(self) -> None:
        """Apply the new rate; new limits apply from the next goal on."""
        if self._goal is not None:
            change_period(self._timer, 1.0 / self.number("rate"))

    def before_end(self) -> None:
        """Leave the robot stopped, and answer waiting clients."""
        if self._goal is None:
            return
        self._finish(words.ENDING)
        self._publisher.wait_for_all_acked(_LAST_STOP)
        if self.executor is not None:
            # The result is sent by a separate task, after everything already queued.
            until_s = time.monotonic() + _LAST_WORD_S
            while time.monotonic() < until_s:
                self.executor.spin_once(timeout_sec=0.01)

    def destroy_node(self) -> None:
        """Destroy the action before the node that it belongs to."""
        self._server.destroy()
        super().destroy_node()  # type: ignore[no-untyped-call]

    # ---------------------------------------------------------------- goals

    def _judge(self, goal: DriveToPoint.Goal) -> GoalResponse:
        refusal = self._refusal(goal)
        if refusal is None:
            return GoalResponse.ACCEPT
        self.say.warn(
            refusal,
            x=goal.x,
            y=goal.y,
            tolerance=goal.tolerance,
            finest=_FINEST_M,
            coarsest=_COARSEST_M,
            farthest=self.number("max_distance"),
        )
        return GoalResponse.REJECT

    def _refusal(self, goal: DriveToPoint.Goal) -> str | None:
        if not all(map(math.isfinite, (goal.x, goal.y, goal.tolerance))):
            return words.NO_NUMBERS
        here = self._odometry.pose or Pose()
        if here.distance_to(Point(goal.x, goal.y)) > self.number("max_distance"):
            return words.TOO_FAR
        if goal.tolerance != 0 and not _FINEST_M <= goal.tolerance <= _COARSEST_M:
            return words.BAD_TOLERANCE
        return words.HELD if self._emergency.active else None

    def _begin(self, handle: ServerGoalHandle) -> None:
        self._finish(words.REPLACED)
        wanted = handle.request
        chassis = ApproachLimits(self.number("max_speed"), self.number("max_steering"), self.number("wheelbase"))
        tolerance_m = wanted.tolerance or self.number("tolerance")
        approach = Approach(Point(wanted.x, wanted.y), tolerance_m, chassis)
        self._goal = DriveGoal(handle, approach, self.number("patience_s"))
        self._waiting[bytes(handle.goal_id.uuid)] = self._goal.over
        self._goal_pose.tell(approach.goal)
        self.say.info(words.GOAL, x=wanted.x, y=wanted.y, tolerance=tolerance_m)
        handle.execute()
        change_period(self._timer, 1.0 / self.number("rate"))

    async def _execute(self, handle: ServerGoalHandle) -> DriveToPoint.Result:
        """Wait until the timer ends the goal; return the result."""
        return await self._waiting.pop(bytes(handle.goal_id.uuid))

    # ---------------------------------------------------------------- driving

    def _tick(self) -> None:
        goal, pose = self._goal, self._odometry.pose
        if goal is None:
            return
        if goal.handle.is_cancel_requested:
            self._finish(words.CANCELLED)
        elif pose is None:
            if goal.age_s > _NO_ODOMETRY_S:
                self._finish(words.NO_ODOMETRY)
        elif self._odometry.age_s > self.number("stale_after_s"):
            self._finish(words.STALE)
        elif goal.approach.reached(pose):
            self._finish(words.REACHED)
        else:
            self._go_on(goal, pose)

    def _go_on(self, goal: DriveGoal, pose: Pose) -> None:
        progress = goal.watch(pose)
        if progress.stands:
            self._finish(words.STANDS)
        elif progress.has_driven_too_far:
            self._finish(words.DRIVEN_TOO_FAR)
        else:
            self._ask_for(goal.approach.command(pose))
            goal.tell(pose)

    def _finish(self, phrase: str) -> None:
        """Stop, and end the current goal with this phrase; nothing if there is none."""
        goal, self._goal = self._goal, None
        if goal is None:
            return
        self._timer.cancel()
        self._ask_for(STOP)
        self._goal_pose.forget()
        pose = self._odometry.pose
        values = {
            "distance": goal.distance_m(pose),
            "topic": ODOMETRY,
            "stale_s": self.number("stale_after_s"),
            "patience_s": self.number("patience_s"),
        }
        if phrase is words.REACHED:
            self.say.info(phrase, every_s=0.0, **values)
        else:
            self.say.warn(phrase, every_s=0.0, **values)
        goal.finish(phrase is words.REACHED, pose, self.say.text(phrase, **values))

    def _emergency_changed(self, active: bool) -> None:
        if active:
            self._base.stop()
            self.say.error(words.EMERGENCY_HELD)
            self._finish(words.EMERGENCY)
        else:
            self.say.warn(words.RELEASED)

    def _ask_for(self, setpoint: DriveSetpoint) -> None:
        self._publisher.publish(to_message(self, setpoint))


def main(args: list[str] | None = None) -> int:
    """Run the node until it is asked to end."""
    return run(DriveToPointNode, args)


if __name__ == "__main__":
    sys.exit(main())
