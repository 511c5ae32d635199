"""The electronic differential: /drive to the speed of each rear wheel.

The wheels have no mechanical differential, so the inner wheel of a curve is slowed down here. In a
/wheel_commands message every array has three elements, in the order of the names; nan means that
a joint takes no such command (a wheel has no position, the steering no velocity).

The current command is repeated `rate` times a second, so that late subscribers see it. It becomes a
stop at an emergency stop (latched until released), if no /drive has come for `max_age_s` seconds,
at a refused command, and when this node ends. A command is refused if it is not a number or beyond
robot/limits.py, or if its stamp is too old or in the future.
"""

from __future__ import annotations

import math
import time
from typing import Any

from ackermann_msgs.msg import AckermannDriveStamped
from sensor_msgs.msg import JointState

from nodes.parts.commands import (
    FRAME,
    LAST_STOP,
    MAX_WHEEL_SPEED,
    SLOWEST,
    CommandRefusals,
    SolePublisher,
    StallDetector,
    from_message,
)
from nodes.parts.emergency import EmergencyStopListener
from nodes.parts.node import DEPTH, LessonNode, Number, Text, change_period
from nodes.parts.runner import run
from robot.joints import DRIVE_JOINTS
from robot.kinematics import STRAIGHT_BELOW_RAD, TRACK_M, WHEEL_RADIUS_M, WHEELBASE_M, WheelSpeeds, wheel_speeds
from robot.limits import RIM_M_S, SPEED, STEERING, Limits
from robot.safety.several import SlowestCommand
from robot.topics import DRIVE, WHEEL_COMMANDS
from robot.words import STOP, DriveSetpoint
from text.i18n import N_

_STARTED = N_("The electronic differential listens to {topic}")
_STANDING = N_("Standing: {speed:.2f} m/s, steering {steering:.2f} rad -> left {left:.2f}, right {right:.2f} m/s")
_STRAIGHT = N_("Straight: {speed:.2f} m/s, steering {steering:.2f} rad -> left {left:.2f}, right {right:.2f} m/s")
_LEFT = N_("Turning left: {speed:.2f} m/s, steering {steering:.2f} rad -> left {left:.2f}, right {right:.2f} m/s")
_RIGHT = N_("Turning right: {speed:.2f} m/s, steering {steering:.2f} rad -> left {left:.2f}, right {right:.2f} m/s")
_TOO_MUCH = N_("Asked for {speed:.2f} m/s and {steering:.2f} rad, limited to {fastest:g} m/s and {sharpest:g} rad")
_TOO_FAST = N_("The outer wheel would run at {speed:.2f} m/s, the limit is {fastest:.2f}: both are slowed")
_SILENT = N_("No command for {max_age:g} s: stop")
_EMERGENCY = N_("EMERGENCY STOP: the wheels stand until it is released")
_RELEASED = N_("The emergency stop is released; waiting for a new command")
_NO_GATE = N_(
    "Nobody publishes {topic}: the wheels stand. Deck's safety_stop publishes it with gate: true,"
    " the course's does not; drive_topic: /drive in the profile drives without a gate"
)
_LATE_S = 1.0
"""Of several publishers, the slowest command of so long counts, if there is no limit of age."""
_GATE_WITHIN_S = 5.0
"""A long time for a gate that starts together with the other nodes."""

_TOLD_M_S, _TOLD_RAD = 0.05, 0.05
"""Smaller changes of speed and steering are not logged."""


class ElectronicDifferential(LessonNode):
    """Publishes wheel speeds for the newest /drive."""

    NAME = "electronic_differential"
    drive_topic = Text(DRIVE, "Which commands are obeyed: /drive or /drive_safe", fixed=True)
    wheelbase = Number(WHEELBASE_M, "Between front and rear axle", low=0.02, high=10.0, unit="m")
    track = Number(TRACK_M, "Between the rear wheels", low=0.02, high=10.0, unit="m")
    wheel_radius = Number(WHEEL_RADIUS_M, "Radius of a rear wheel", low=0.005, high=2.0, unit="m")
    max_speed = Number(SPEED.high, "Faster commands are slowed to it", low=0.01, high=SPEED.high, unit="m/s")
    max_steering = Number(STEERING.high, "Limit of the steering", low=0.05, high=STEERING.high, unit="rad")
    max_wheel_speed = MAX_WHEEL_SPEED
    rate = Number(2.0, "Repetitions of the command a second", low=0.5, high=100.0, unit="Hz")
    max_age_s = Number(0.0, "A command older than this becomes a stop; 0: never", high=60.0, unit="s")

    def __init__(self) -> None:
        super().__init__()
        self._command = STOP
        self._stalls = StallDetector()
        self._refusals = CommandRefusals(self)
        self._heard = False
        self._told: DriveSetpoint | None = None
        topic = self.drive_topic
        self._publisher = self.create_publisher(JointState, WHEEL_COMMANDS, DEPTH)
        SolePublisher(self, self._publisher.topic_name, own=True, others=SLOWEST)
        self._emergency = EmergencyStopListener(self, self._emergency_changed)
        self._commands: SlowestCommand[DriveSetpoint] = SlowestCommand()
        hear: Any = self._hear
        self.create_subscription(AckermannDriveStamped, topic, hear, DEPTH)
        self._timer = self.every(1.0 / self.rate, self._repeat)
        self._deadline = self.every(1.0, self._too_late)
        self._await_next()
        self._gate_look = self.every(_GATE_WITHIN_S, self._miss_gate)
        if topic == DRIVE:
            # Without a gate, silence only means that no person has sent a command yet.
            self._gate_look.cancel()
        self.say.info(_STARTED, topic=topic)

    def parameters_changed(self) -> None:
        """Apply the new rate, and the new chassis with the next command."""
        change_period(self._timer, 1.0 / self.rate)
        self._await_next()

    def before_end(self) -> None:
        """Leave the wheels stopped."""
        self._command = STOP
        self._publish()
        self._publisher.wait_for_all_acked(LAST_STOP)

    def _hear(self, message: AckermannDriveStamped, info: dict[str, Any]) -> None:
        stamp = message.header.stamp
        if self._held_up() or self._stalls.kept_waiting(stamp):
            return
        self._await_next()
        if self._emergency.active:
            return
        self._heard = True
        self._command = self._slowest(self._granted(message), info)
        self._publish()
        # The next repetition is timed from here.
        self._timer.reset()

    def _slowest(self, command: DriveSetpoint, info: dict[str, Any]) -> DriveSetpoint:
        """Return what counts if others publish beside the gate; on /drive many may."""
        topic = self.drive_topic
        chosen = self._commands.choose(
            command,
            command.speed_m_s,
            time.monotonic(),
            within_s=self.max_age_s or _LATE_S,
            number=info.get("publication_sequence_number") or 0,
            publishers=1 if topic == DRIVE else self.count_publishers(topic),
        )
        return STOP if chosen is None else chosen

    def _granted(self, message: AckermannDriveStamped) -> DriveSetpoint:
        """Return the command within this chassis's limits, a stop if it is refused."""
        asked, topic = from_message(message), self.drive_topic
        refused = self._refusals.beyond(
            topic, (asked.speed_m_s, SPEED), (asked.steering_rad, STEERING)
        ) or self._refusals.untimely(topic, message.header.stamp, self.max_age_s)
        return STOP if refused else self._limited(asked)

    def _limited(self, asked: DriveSetpoint) -> DriveSetpoint:
        speed, steering = asked.speed_m_s, asked.steering_rad
        fastest, sharpest = self.max_speed, self.max_steering
        speeds, angles = Limits(-fastest, fastest, "m/s"), Limits(-sharpest, sharpest, "rad")
        if not (speeds.allow(speed) and angles.allow(steering)):
            self.say.warn(_TOO_MUCH, every_s=1.0, speed=speed, steering=steering, fastest=fastest, sharpest=sharpest)
        return DriveSetpoint(speeds.clamped(speed), angles.clamped(steering))

    def _wheels(self) -> WheelSpeeds:
        """Return the wheel speeds for the command, the outer one within its limit."""
        speed, steering = self._command.speed_m_s, self._command.steering_rad
        asked = wheel_speeds(speed, steering, self.wheelbase, self.track)
        fastest = min(RIM_M_S, self.max_wheel_speed * self.wheel_radius)
        wheels = asked.slowed_to(fastest)
        if wheels is not asked:
            self.say.warn(_TOO_FAST, every_s=5.0, speed=asked.fastest_m_s, fastest=fastest)
        return wheels

    def _await_next(self) -> None:
        """Allow `max_age_s` from now for the next command."""
        max_age_s = self.max_age_s
        if max_age_s > 0:
            change_period(self._deadline, max_age_s)
        else:
            self._deadline.cancel()

    def _held_up(self) -> bool:
        """Whether to ignore messages now, as they may have waited too long."""
        max_age_s = self.max_age_s or math.inf
        return self._stalls.lasted(max_age_s + 1.0 / self.rate)

    def _repeat(self) -> None:
        self._held_up()
        left_ns = self._deadline.time_until_next_call()
        if left_ns is not None and left_ns <= 0:
            # A node that was suspended finds both timers due, in any order.
            self._too_late()
        self._publish()

    def _too_late(self) -> None:
        self._deadline.cancel()
        if self._command != STOP:
            self.say.warn(_SILENT, max_age=self.max_age_s)
            self._command = STOP
            self._publish()

    def _miss_gate(self) -> None:
        self._gate_look.cancel()
        topic = self.drive_topic
        if not self.count_publishers(topic):
            self.say.warn(_NO_GATE, topic=topic)

    def _emergency_changed(self, active: bool) -> None:
        self._command = STOP
        if active:
            self.say.error(_EMERGENCY)
        else:
            self.say.warn(_RELEASED)
        self._publish()

    def _publish(self) -> None:
        wheels = self._wheels()
        message = JointState()
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = FRAME
        message.name = list(DRIVE_JOINTS)
        message.position = [math.nan, math.nan, self._command.steering_rad]
        radius_m = self.wheel_radius
        message.velocity = [wheels.left_m_s / radius_m, wheels.right_m_s / radius_m, math.nan]
        self._publisher.publish(message)
        if self._heard and not _much_the_same(self._command, self._told):
            self._tell(wheels)

    def _tell(self, wheels: WheelSpeeds) -> None:
        command = self._command
        if command.speed_m_s == 0:
            phrase = _STANDING
        elif abs(command.steering_rad) < STRAIGHT_BELOW_RAD:
            phrase = _STRAIGHT
        else:
            phrase = _LEFT if command.steering_rad > 0 else _RIGHT
        self.say.info(
            phrase,
            speed=command.speed_m_s,
            steering=command.steering_rad,
            left=wheels.left_m_s,
            right=wheels.right_m_s,
        )
        self._told = command


def _much_the_same(command: DriveSetpoint, told: DriveSetpoint | None) -> bool:
    """Whether to skip logging: a gate slows down a little with each reading of a sonar."""
    if told is None or (command.speed_m_s == 0.0) != (told.speed_m_s == 0.0):
        return False
    faster = abs(command.speed_m_s - told.speed_m_s)
    return faster < _TOLD_M_S and abs(command.steering_rad - told.steering_rad) < _TOLD_RAD


if __name__ == "__main__":
    raise SystemExit(run(ElectronicDifferential))
