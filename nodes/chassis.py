"""The chassis: /wheel_commands to the Pico on a serial port, and the Pico's reports back.

A drive line goes out `rate` times a second, with or without a command: it is the heartbeat without
which the Pico stops within 250 ms. A command counts as a stop if it is older than `max_age_s`, is
not a number, is beyond robot/limits.py, or came before the end of an emergency stop, a fault or a
reconnection. /emergency_stop is latched here and in the Pico; a stop that the Pico has kept also
stops this node.

Published with every telemetry (50 Hz), if anybody subscribes: /joint_states, /odom, /tf; /battery
and /diagnostics once a second. The node reconnects by itself. It sends a stop before it ends.
"""

from __future__ import annotations

import math
import threading
import time
from typing import Any

from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticStatus
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState, JointState
from tf2_msgs.msg import TFMessage

from nodes.drivers.diagnostics import tell_every_second
from nodes.drivers.pico import (
    COMMAND_OLD,
    EMERGENCY,
    RELEASED,
    STARTED,
    TOO_FAST,
    PicoClient,
    StandstillLogger,
    diagnosis,
)
from nodes.parts.commands import MAX_WHEEL_SPEED, CommandRefusals, StallDetector
from nodes.parts.emergency import PICO, EmergencyStopListener
from nodes.parts.node import DEPTH, LessonNode, Number, PeriodicThread, Text, Whole
from nodes.parts.odometry import fill, transform_to
from nodes.parts.runner import run
from robot.joints import DRIVE_JOINTS
from robot.kinematics import WHEEL_RADIUS_M, WHEELBASE_M
from robot.limits import STEERING, wheel_limits
from robot.motion.odometry import Pose, advance
from robot.safety.several import SlowestCommand
from robot.topics import BATTERY, JOINT_STATES, ODOMETRY, TF, WHEEL_COMMANDS
from robot.wire.pico import Telemetry
from robot.words import DriveSetpoint

_LONGEST_GAP_S = 1.0
"""After a longer silence the robot's motion is unknown."""
_SHARPEST_RAD = 1.4


class DeadReckoning:
    """Integrates the motion of the wheels."""

    def __init__(self, wheelbase_m: float, radius_m: float) -> None:
        self._wheelbase_m, self._radius_m = wheelbase_m, radius_m
        self._uptime_ms: int | None = None
        self._angles = [0.0, 0.0]
        self._odometry = Odometry()
        self.pose = Pose()

    def take(self, telemetry: Telemetry) -> None:
        before, self._uptime_ms = self._uptime_ms, telemetry.uptime_ms
        passed_s = ((telemetry.uptime_ms - before) % 2**32) / 1000 if before is not None else 0.0
        if passed_s > _LONGEST_GAP_S:
            return
        self.pose = advance(self.pose, self._command(telemetry), passed_s, self._wheelbase_m)
        for side, speed in enumerate((telemetry.left_rad_s, telemetry.right_rad_s)):
            self._angles[side] += speed * passed_s

    def joints(self, telemetry: Telemetry, stamp: Time) -> JointState:
        """Return /joint_states: positions and speeds in the order of `DRIVE_JOINTS`."""
        message = JointState(name=list(DRIVE_JOINTS))
        message.header.stamp = stamp
        message.position = [*self._angles, telemetry.steering_rad]
        message.velocity = [telemetry.left_rad_s, telemetry.right_rad_s, math.nan]
        return message

    def odometry(self, telemetry: Telemetry, stamp: Time) -> Odometry:
        """Return /odom: the same message object each time, refilled."""
        fill(self._odometry, self.pose, self._command(telemetry), self._wheelbase_m, stamp)
        return self._odometry

    def _command(self, telemetry: Telemetry) -> DriveSetpoint:
        """Return the robot's actual motion as a drive command."""
        mean_rad_s = (telemetry.left_rad_s + telemetry.right_rad_s) / 2
        steering = max(-_SHARPEST_RAD, min(_SHARPEST_RAD, telemetry.steering_rad))
        return DriveSetpoint(mean_rad_s * self._radius_m, steering)


def battery(telemetry: Telemetry, stamp: Time) -> BatteryState:
    """Return /battery; nan for what is not measured."""
    message = BatteryState()
    message.header.stamp = stamp
    known = telemetry.battery_v is not None
    message.voltage = telemetry.battery_v if known else math.nan
    currents = (telemetry.left_a, telemetry.right_a)
    told = [current for current in currents if current is not None]
    # The message defines it as negative while discharging.
    message.current = -sum(told) if told else math.nan
    for field in ("temperature", "charge", "capacity", "design_capacity", "percentage"):
        setattr(message, field, math.nan)
    message.power_supply_status = BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
    message.power_supply_health = (
        BatteryState.POWER_SUPPLY_HEALTH_DEAD
        if "U" in telemetry.flags
        else BatteryState.POWER_SUPPLY_HEALTH_GOOD
        if known
        else BatteryState.POWER_SUPPLY_HEALTH_UNKNOWN
    )
    message.present = known
    return message


_STILL = (0.0, 0.0, 0.0)
_REARMS = frozenset("ELRUHA")
"""Flags of the Pico after which only a new command is obeyed."""
_BATTERY_EVERY_S = 1.0
_SETTLES_S = 0.5
"""For this long after a release the Pico may still report the previous stop."""
_AWAY_S = 0.5
"""A node that was suspended for longer ignores commands that have waited meanwhile."""


class ChassisNode(LessonNode):
    """Sends periodically and on each command; publishes from the reader's thread."""

    NAME = "chassis"
    port = Text("/dev/ttyACM0", "Device path; best one in /dev/serial/by-id", fixed=True)
    baud = Whole(115_200, "Speed of the port", fixed=True, low=9600, high=921_600)
    rate = Number(50.0, "Drive lines a second", low=20.0, high=100.0, unit="Hz")
    max_age_s = Number(1.0, "An older command is a stop", low=0.05, high=60.0, unit="s")
    wheelbase = Number(WHEELBASE_M, "Between front and rear axle", fixed=True, low=0.02, high=10.0, unit="m")
    wheel_radius = Number(WHEEL_RADIUS_M, "Radius of a rear wheel", fixed=True, low=0.005, high=2.0, unit="m")
    max_wheel_speed = MAX_WHEEL_SPEED

    def __init__(self) -> None:
        super().__init__()
        self._command = _STILL
        self._commanded_s = -math.inf
        self._standstill = StandstillLogger(self.say)
        self._release_wanted = False
        self._released_s = -math.inf
        self._stalls = StallDetector()
        self._refusals = CommandRefusals(self)
        self._wheel_limits = wheel_limits(self.wheel_radius)
        self._sending = threading.Lock()
        self._reckoning = DeadReckoning(self.wheelbase, self.wheel_radius)
        self._pico = PicoClient(self, self.baud, self._hear)
        self._joints = self.quick_publisher(JointState, JOINT_STATES)
        self._odometry = self.quick_publisher(Odometry, ODOMETRY)
        self._transforms = self.quick_publisher(TFMessage, TF)
        self._battery = self.quick_publisher(BatteryState, BATTERY)
        # Released even if this node never saw the stop: the Pico may have kept it.
        self._emergency = EmergencyStopListener(self, self._emergency_changed, self._hear_release)
        self._commands: SlowestCommand[tuple[float, float, float]] = SlowestCommand()
        obey: Any = self._obey
        self.create_subscription(JointState, WHEEL_COMMANDS, obey, DEPTH)
        self._pace = PeriodicThread(1.0 / self.rate, self._drive)
        self.every(_BATTERY_EVERY_S, self._publish_battery)
        tell_every_second(self, self._status)
        self.say.info(STARTED, port=self._pico.link.port, topic=WHEEL_COMMANDS)
        self._pico.link.start()
        self._pace.start()

    def parameters_changed(self) -> None:
        """Apply the new rate."""
        self._pace.period_s = 1.0 / self.rate

    def before_end(self) -> None:
        """Leave the wheels stopped, and release the port."""
        self._pace.close()
        self._pico.drive(*_STILL)
        self._pico.link.close()

    # ---------------------------------------------------------------- the node's thread

    def _obey(self, message: JointState, info: dict[str, Any]) -> None:
        stamp = message.header.stamp
        if self._stalls.lasted(_AWAY_S) or self._stalls.kept_waiting(stamp):
            return
        command = _STILL if self._emergency.active else self._slowest(message, info)
        with self._sending:
            self._commanded_s = time.monotonic()
            if command != self._command:
                # A repeated command goes out with the next periodic line.
                self._command = command
                self._send()

    def _slowest(self, message: JointState, info: dict[str, Any]) -> tuple[float, float, float]:
        """Return what counts if others publish beside the differential."""
        command = self._granted(message)
        chosen = self._commands.choose(
            command,
            max(command[:2], key=abs),
            time.monotonic(),
            within_s=self.max_age_s,
            number=info.get("publication_sequence_number") or 0,
            publishers=self.count_publishers(WHEEL_COMMANDS),
        )
        return _STILL if chosen is None else chosen

    def _granted(self, message: JointState) -> tuple[float, float, float]:
        """Return the command within what these motors can do, a stop if it is refused."""
        velocity = dict(zip(message.name, message.velocity, strict=False))
        position = dict(zip(message.name, message.position, strict=False))
        left, right = (velocity.get(joint, math.nan) for joint in DRIVE_JOINTS[:2])
        steering = position.get(DRIVE_JOINTS[2], math.nan)
        refused = self._refusals.beyond(
            WHEEL_COMMANDS, (left, self._wheel_limits), (right, self._wheel_limits), (steering, STEERING)
        ) or self._refusals.untimely(WHEEL_COMMANDS, message.header.stamp, self.max_age_s)
        if refused:
            return _STILL
        part = self._part_of(max(abs(left), abs(right)))
        return (left * part, right * part, steering)

    def _part_of(self, asked_rad_s: float) -> float:
        """Return the share of that speed that the motors can reach, 0 to 1; logged if below 1."""
        most_rad_s = self.max_wheel_speed
        if asked_rad_s <= most_rad_s:
            return 1.0
        self.say.warn(TOO_FAST, every_s=5.0, speed=asked_rad_s, fastest=most_rad_s)
        return most_rad_s / asked_rad_s

    def _emergency_changed(self, active: bool) -> None:
        with self._sending:
            self._command = _STILL
            self._want_release(not active)
            if active:
                self._pico.halt()
            else:
                self._pico.release()
        if active:
            self.say.error(EMERGENCY)
        else:
            self.say.warn(RELEASED)

    def _hear_release(self) -> None:
        with self._sending:
            self._want_release(True)

    def _want_release(self, wanted: bool) -> None:
        self._release_wanted = wanted
        if wanted:
            self._released_s = time.monotonic()

    def _take_over(self) -> None:
        """Adopt the stop that the Pico keeps: an earlier one, or another program's.

        But not one whose release is still on its way.
        """
        telemetry = self._pico.telemetry
        kept = telemetry is not None and "E" in telemetry.flags
        if kept and not self._release_wanted:
            self._emergency.engage(PICO)

    def _publish_battery(self) -> None:
        telemetry = self._pico.telemetry
        if telemetry is not None and self._pico.answers:
            self._battery.publish(battery(telemetry, self.get_clock().now().to_msg()))

    def _status(self) -> DiagnosticStatus:
        pico = self._pico
        status = pico.link.status(self.get_name(), pico.errors, pico.frames)
        return diagnosis(self.say, status, pico, self._emergency.active, self._refusals.recent)

    # ---------------------------------------------------------------- at a pace

    def _drive(self) -> None:
        away = self._stalls.lasted(_AWAY_S)
        with self._sending:
            late = away or time.monotonic() - self._commanded_s > self.max_age_s
            if late and self._command[:2] != _STILL[:2]:
                self.say.warn(COMMAND_OLD, seconds=self.max_age_s)
                self._stand()
            self._send()
        self._standstill.tell(self._pico.telemetry)

    def _send(self) -> None:
        telemetry = self._pico.telemetry
        flags = telemetry.flags if telemetry is not None else _REARMS
        if flags & _REARMS:
            self._stand()
        if telemetry is not None:
            if self._emergency.active and "E" not in flags:
                self._pico.halt()
            # Repeated until it arrives, as a line may be lost.
            if self._release_wanted and "E" in flags:
                self._pico.release()
            elif time.monotonic() - self._released_s > _SETTLES_S:
                self._release_wanted = False
        self._pico.drive(*self._command)

    def _stand(self) -> None:
        """Forget the command; the steering angle stays."""
        self._command = (0.0, 0.0, self._command[2])

    # ---------------------------------------------------------------- the reader's thread

    def _hear(self, telemetry: Telemetry) -> None:
        if not self.context.ok():
            return
        self._reckoning.take(telemetry)
        if "E" in telemetry.flags and not self._emergency.active and self.executor is not None:
            self.executor.create_task(self._take_over)
        stamp = self.get_clock().now().to_msg()
        if self._joints.get_subscription_count():
            self._joints.publish(self._reckoning.joints(telemetry, stamp))
        if self._odometry.get_subscription_count():
            self._odometry.publish(self._reckoning.odometry(telemetry, stamp))
        if self._transforms.get_subscription_count():
            self._transforms.publish(TFMessage(transforms=[transform_to(self._reckoning.pose, stamp)]))


if __name__ == "__main__":
    raise SystemExit(run(ChassisNode))
