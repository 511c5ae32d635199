"""The Pico's reports as ROS messages."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from geometry_msgs.msg import Quaternion, TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState, JointState
from std_msgs.msg import Header

from nodes.parts.drive import FRAME
from nodes.parts.odometry import ODOM
from robot.joints import DRIVE_JOINTS
from robot.kinematics import turning_radius
from robot.motion.odometry import Pose, advance
from robot.words import DriveSetpoint
from space.transform import quaternion_from_rpy

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time

    from robot.wire.pico import Telemetry

_LONGEST_GAP_S = 1.0
"""After a longer silence the robot's motion is unknown."""
_SHARPEST_RAD = 1.4


class DeadReckoning:
    """Integrates the motion of the wheels."""

    def __init__(self, wheelbase_m: float, radius_m: float) -> None:
        self._wheelbase_m, self._radius_m = wheelbase_m, radius_m
        self._uptime_ms: int | None = None
        self._angles = [0.0, 0.0]
        self._odometry = Odometry(header=Header(frame_id=ODOM), child_frame_id=FRAME)
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
        message = self._odometry
        message.header.stamp = stamp
        message.pose.pose.position.x = self.pose.x_m
        message.pose.pose.position.y = self.pose.y_m
        message.pose.pose.orientation = self._orientation()
        command = self._command(telemetry)
        radius_m = turning_radius(command.steering_rad, self._wheelbase_m)
        message.twist.twist.linear.x = command.speed_m_s
        message.twist.twist.angular.z = command.speed_m_s / radius_m
        return message

    def transform(self, stamp: Time) -> TransformStamped:
        """Return /tf: odom to base_link."""
        message = TransformStamped()
        message.header = Header(stamp=stamp, frame_id=ODOM)
        message.child_frame_id = FRAME
        moved = message.transform.translation
        moved.x, moved.y = self.pose.x_m, self.pose.y_m
        message.transform.rotation = self._orientation()
        return message

    def _orientation(self) -> Quaternion:
        x, y, z, w = quaternion_from_rpy(0.0, 0.0, self.pose.heading_rad)
        return Quaternion(x=x, y=y, z=z, w=w)

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
