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
import time

from ackermann_msgs.msg import AckermannDriveStamped
from deck_interfaces.action import DriveToPoint
from geometry_msgs.msg import PoseStamped
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse, ServerGoalHandle
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future

from nodes.parts.commands import LAST_STOP, to_message
from nodes.parts.emergency import EmergencyStopListener
from nodes.parts.node import DEPTH, LATCHED, Choice, LessonNode, Number, Text, change_period
from nodes.parts.odometry import ODOM, OdometryListener
from nodes.parts.runner import run
from nodes.simulated.base import ALWAYS, AUTO, NEVER, WAIT_S, SimulatedBase
from robot.kinematics import WHEELBASE_M
from robot.limits import SPEED, STEERING
from robot.motion.approach import Approach, ApproachLimits, ApproachProgress
from robot.motion.odometry import Point, Pose
from robot.topics import DRIVE, DRIVE_TO_POINT, GOAL_POSE, ODOMETRY
from robot.words import STOP, DriveSetpoint
from text.i18n import N_

_STARTED = N_("Ready to drive to a point: action {action}")
_GOAL = N_("Driving to x {x:.2f}, y {y:.2f} m, to within {tolerance:.2f} m")

_REACHED = N_("Arrived: the point is {distance:.2f} m away")
_CANCELLED = N_("Cancelled as asked, {distance:.2f} m from the point")
_REPLACED = N_("Preempted by a newer goal, {distance:.2f} m from the point")
_NO_ODOMETRY = N_("Nobody publishes {topic}: the robot's position is unknown; start its base, or simulate:=auto")
_STALE = N_("No {topic} for {stale_s:g} s, {distance:.2f} m from the point: the base is gone")
_STANDS = N_(
    "The robot has not moved for {patience_s:g} s, {distance:.2f} m from the point: "
    "something holds it, a safety gate or an obstacle"
)
_DRIVEN_TOO_FAR = N_(
    "The robot drives but does not arrive, {distance:.2f} m from the point: "
    "is the odometry right, and is nobody else steering?"
)
_EMERGENCY = N_("Emergency stop, {distance:.2f} m from the point")
_ENDING = N_("The node is ending, {distance:.2f} m from the point")

_NO_NUMBERS = N_("Refused: x {x}, y {y}, tolerance {tolerance} are not all numbers")
_TOO_FAR = N_("Refused: x {x:g}, y {y:g} m is farther away than {farthest:g} m (max_distance)")
_BAD_TOLERANCE = N_("Refused: tolerance {tolerance:g} m, must be 0 or from {finest:g} to {coarsest:g} m")
_HELD = N_("Refused: the emergency stop is held, release it first")
_EMERGENCY_HELD = N_("EMERGENCY STOP: no goal is driven to until it is released")
_RELEASED = N_("The emergency stop is released; waiting for a new goal")


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


_FINEST_M, _COARSEST_M = 0.02, 2.0
_NO_ODOMETRY_S = WAIT_S + 1.0
"""How long a goal waits for a first pose."""
_LAST_WORD_S = 0.2
"""How long the result may take to reach its clients."""


class DriveToPointNode(LessonNode):
    """Drives to one point at a time."""

    NAME = "drive_to_point"
    simulate = Choice(
        AUTO, "A simulated base publishes /odom; auto: if nobody else does", fixed=True, choices=(AUTO, ALWAYS, NEVER)
    )
    base_topic = Text(DRIVE, "Commands that the simulated base obeys", fixed=True)
    max_speed = Number(0.3, "Maximum speed", low=0.05, high=SPEED.high, unit="m/s")
    max_steering = Number(0.5, "Maximum steering angle", low=0.1, high=STEERING.high, unit="rad")
    wheelbase = Number(WHEELBASE_M, "Between front and rear axle", fixed=True, low=0.02, high=10.0, unit="m")
    tolerance = Number(0.1, "Tolerance for a goal that sets none (0)", low=_FINEST_M, high=_COARSEST_M, unit="m")
    max_distance = Number(20.0, "A farther goal is refused", low=0.1, high=1000.0, unit="m")
    rate = Number(20.0, "Commands a second while driving", low=5.0, high=100.0, unit="Hz")
    stale_after_s = Number(1.0, "A longer silence of /odom ends a drive", low=0.1, high=60.0, unit="s")
    patience_s = Number(5.0, "Standing longer than this ends a drive", low=0.5, high=600.0, unit="s")

    def __init__(self) -> None:
        super().__init__()
        self._goal: DriveGoal | None = None
        self._waiting: dict[bytes, Future] = {}
        """Goals whose results have not been sent to their clients yet."""
        self._publisher = self.create_publisher(AckermannDriveStamped, DRIVE, DEPTH)
        self._goal_pose = self.create_publisher(PoseStamped, GOAL_POSE, LATCHED)
        self._emergency = EmergencyStopListener(self, self._emergency_changed)
        self._odometry = OdometryListener(self)
        self._base = SimulatedBase(
            self, self.simulate, self.base_topic, self.wheelbase, held=lambda: self._emergency.active
        )
        self._timer = self.every(1.0 / self.rate, self._tick)
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
        self.say.info(_STARTED, action=DRIVE_TO_POINT)

    def parameters_changed(self) -> None:
        """Apply the new rate; new limits apply from the next goal on."""
        if self._goal is not None:
            change_period(self._timer, 1.0 / self.rate)

    def before_end(self) -> None:
        """Leave the robot stopped, and answer waiting clients."""
        if self._goal is None:
            return
        self._finish(_ENDING)
        self._publisher.wait_for_all_acked(LAST_STOP)
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
            farthest=self.max_distance,
        )
        return GoalResponse.REJECT

    def _refusal(self, goal: DriveToPoint.Goal) -> str | None:
        if not all(map(math.isfinite, (goal.x, goal.y, goal.tolerance))):
            return _NO_NUMBERS
        here = self._odometry.pose or Pose()
        if here.distance_to(Point(goal.x, goal.y)) > self.max_distance:
            return _TOO_FAR
        if goal.tolerance != 0 and not _FINEST_M <= goal.tolerance <= _COARSEST_M:
            return _BAD_TOLERANCE
        return _HELD if self._emergency.active else None

    def _begin(self, handle: ServerGoalHandle) -> None:
        self._finish(_REPLACED)
        wanted = handle.request
        chassis = ApproachLimits(self.max_speed, self.max_steering, self.wheelbase)
        tolerance_m = wanted.tolerance or self.tolerance
        approach = Approach(Point(wanted.x, wanted.y), tolerance_m, chassis)
        self._goal = DriveGoal(handle, approach, self.patience_s)
        self._waiting[bytes(handle.goal_id.uuid)] = self._goal.over
        self._tell_goal(approach.goal)
        self.say.info(_GOAL, x=wanted.x, y=wanted.y, tolerance=tolerance_m)
        handle.execute()
        change_period(self._timer, 1.0 / self.rate)

    async def _execute(self, handle: ServerGoalHandle) -> DriveToPoint.Result:
        """Wait until the timer ends the goal; return the result."""
        return await self._waiting.pop(bytes(handle.goal_id.uuid))

    # ---------------------------------------------------------------- driving

    def _tick(self) -> None:
        goal, pose = self._goal, self._odometry.pose
        if goal is None:
            return
        if goal.handle.is_cancel_requested:
            self._finish(_CANCELLED)
        elif pose is None:
            if goal.age_s > _NO_ODOMETRY_S:
                self._finish(_NO_ODOMETRY)
        elif self._odometry.age_s > self.stale_after_s:
            self._finish(_STALE)
        elif goal.approach.reached(pose):
            self._finish(_REACHED)
        else:
            self._go_on(goal, pose)

    def _go_on(self, goal: DriveGoal, pose: Pose) -> None:
        progress = goal.watch(pose)
        if progress.stands:
            self._finish(_STANDS)
        elif progress.has_driven_too_far:
            self._finish(_DRIVEN_TOO_FAR)
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
        self._tell_goal(None)
        pose = self._odometry.pose
        values = {
            "distance": goal.distance_m(pose),
            "topic": ODOMETRY,
            "stale_s": self.stale_after_s,
            "patience_s": self.patience_s,
        }
        if phrase is _REACHED:
            self.say.info(phrase, every_s=0.0, **values)
        else:
            self.say.warn(phrase, every_s=0.0, **values)
        goal.finish(phrase is _REACHED, pose, self.say.text(phrase, **values))

    def _tell_goal(self, point: Point | None) -> None:
        """Publish the goal, at which the robot may arrive with any heading; None: there is none any more."""
        message = PoseStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        message.pose.orientation.w = 1.0
        if point is not None:
            message.header.frame_id = ODOM
            message.pose.position.x, message.pose.position.y = point.x_m, point.y_m
        self._goal_pose.publish(message)

    def _emergency_changed(self, active: bool) -> None:
        if active:
            self._base.stop()
            self.say.error(_EMERGENCY_HELD)
            self._finish(_EMERGENCY)
        else:
            self.say.warn(_RELEASED)

    def _ask_for(self, setpoint: DriveSetpoint) -> None:
        self._publisher.publish(to_message(self, setpoint))


if __name__ == "__main__":
    raise SystemExit(run(DriveToPointNode))
