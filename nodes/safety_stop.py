"""The reflex: watches the distance and, as a gate, lets no command through that is dangerous.

An obstacle nearer than `critical_distance`, a reading that is no distance (nan), and no reading
for `stale_after_s` seconds are all danger. With `gate: true` the node stands between /drive and
/drive_safe: forward is blocked while the front is in danger, backward while the rear is (if a
`rear_topic` is given; without one, backing off is always allowed). A command that was cut short
is forgotten: when the way is free again the robot waits for a new one. What is allowed at the
moment is repeated `rate` times a second, so that who obeys /drive_safe can tell a dead gate.

/emergency_stop stops everything until it is released by an explicit false. /safety_state says
at every change, and once a second, what is blocked and why.
"""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

from ackermann_msgs.msg import AckermannDriveStamped
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import Float32

from nodes._drive import from_message, to_message
from nodes._emergency import EmergencyStop
from nodes._life import run
from nodes._node import LessonNode, change_period
from nodes._parameters import Number, Switch, Text
from nodes._safety_words import (
    COMMAND_CUT,
    COMMAND_OLD,
    EMERGENCY,
    RELEASED,
    STARTED,
    View,
    diagnosis,
    tell_front,
)
from nodes._topics import DEPTH, DRIVE, DRIVE_SAFE, SAFETY_STATE, SONAR_FRONT
from robot.safety import Reading, Sight, Verdict, gate, look, where
from robot.words import STOP, DriveSetpoint

if TYPE_CHECKING:
    from rclpy.publisher import Publisher

_STATE_EVERY_S = 1.0


class Eye:
    """One distance sensor, as it is now."""

    def __init__(self) -> None:
        self._distance_m: float | None = None
        self._seen_s = time.monotonic()

    def see(self, distance_m: float) -> None:
        """Take a new reading."""
        self._distance_m = distance_m
        self._seen_s = time.monotonic()

    @property
    def reading(self) -> Reading:
        """The newest reading and its age."""
        return Reading(self._distance_m, time.monotonic() - self._seen_s)


class SafetyStop(LessonNode):
    """Warns of obstacles, and blocks motion if it is the gate."""

    NAME = "safety_node"
    SETTINGS = (
        Text("front_topic", SONAR_FRONT, "Distance ahead", fixed=True),
        Text("rear_topic", "", "Distance behind; empty: no sensor", fixed=True, may_be_empty=True),
        Number(
            "critical_distance", 0.5, "Nearer than this is danger", low=0.01, high=100.0, unit="m"
        ),
        Number(
            "stale_after_s",
            2.5,
            "A longer silence of a sonar is danger",
            low=0.05,
            high=60.0,
            unit="s",
        ),
        Switch("gate", False, "Whether to relay /drive to /drive_safe", fixed=True),
        Number("max_age_s", 0.0, "An older /drive becomes a stop; 0: never", high=60.0, unit="s"),
        Number(
            "rate", 5.0, "Looks, and repetitions of /drive_safe", low=1.0, high=100.0, unit="Hz"
        ),
    )

    def __init__(self) -> None:
        super().__init__()
        self._front = Eye()
        self._rear = Eye() if self.text("rear_topic") else None
        self._sights: tuple[Sight, Sight | None] = (Sight.SILENT, None)
        self._verdict = Verdict.BLOCKED_FORWARD
        self._command = STOP
        self._commanded_s = time.monotonic()
        self._told_s = 0.0
        self._state = self.create_publisher(DiagnosticArray, SAFETY_STATE, DEPTH)
        self._safe: Publisher | None = None
        if self.switch("gate"):
            self._safe = self.create_publisher(AckermannDriveStamped, DRIVE_SAFE, DEPTH)
            self.create_subscription(AckermannDriveStamped, DRIVE, self._drive, DEPTH)
        self._emergency = EmergencyStop(self, self._emergency_changed)
        self.create_subscription(Float32, self.text("front_topic"), self._see_front, DEPTH)
        if self._rear is not None:
            self.create_subscription(Float32, self.text("rear_topic"), self._see_rear, DEPTH)
        self._timer = self.every(1.0 / self.number("rate"), self._tick)
        self.say.info(STARTED, metres=self.number("critical_distance"))

    def parameters_changed(self) -> None:
        """Keep the new rate, and look again with the new distances."""
        change_period(self._timer, 1.0 / self.number("rate"))
        self._judge()

    def before_end(self) -> None:
        """A gate that goes leaves the robot standing."""
        self._let_through(STOP)

    # ---------------------------------------------------------------- what comes in

    def _see_front(self, message: Float32) -> None:
        self._front.see(message.data)
        self._judge()
        tell_front(self.say, self._sights[0], self._front.reading)

    def _see_rear(self, message: Float32) -> None:
        if self._rear is not None:
            self._rear.see(message.data)
            self._judge()

    def _emergency_changed(self, active: bool) -> None:
        if active:
            self.say.error(EMERGENCY)
        else:
            self.say.warn(RELEASED)
        self._judge()

    def _drive(self, message: AckermannDriveStamped) -> None:
        self._commanded_s = time.monotonic()
        self._judge()
        asked = from_message(message)
        self._let_through(self._allowed(asked))

    def _tick(self) -> None:
        self._judge()
        if self._front.reading.age_s > self.number("stale_after_s"):
            tell_front(self.say, Sight.SILENT, self._front.reading)
        max_age_s = self.number("max_age_s")
        if max_age_s and time.monotonic() - self._commanded_s > max_age_s and self._command != STOP:
            self.say.warn(COMMAND_OLD, seconds=max_age_s)
            self._command = STOP
        self._let_through(self._command)
        if time.monotonic() - self._told_s > _STATE_EVERY_S:
            self._publish_state()

    # ---------------------------------------------------------------- what follows from it

    def _judge(self) -> None:
        critical_m, stale_s = self.number("critical_distance"), self.number("stale_after_s")
        sights = (
            look(self._front.reading, critical_m, stale_s),
            look(self._rear.reading, critical_m, stale_s) if self._rear else None,
        )
        verdict = where(*sights, self._emergency.active)
        if (sights, verdict) == (self._sights, self._verdict):
            return
        self._sights, self._verdict = sights, verdict
        allowed = self._allowed(self._command)
        if allowed != self._command:
            self._let_through(allowed)
        self._publish_state()

    def _allowed(self, asked: DriveSetpoint) -> DriveSetpoint:
        allowed = gate(asked, self._verdict)
        if allowed != asked and self._safe is not None:
            self.say.warn(
                COMMAND_CUT,
                every_s=1.0,
                speed=asked.speed_m_s,
                steering=asked.steering_rad,
                reason=self._status().message,
            )
        return allowed

    def _let_through(self, command: DriveSetpoint) -> None:
        self._command = command
        if self._safe is not None:
            self._safe.publish(to_message(self, command))

    def _status(self) -> DiagnosticStatus:
        front, rear = self._sights
        views = [View("front", front, self._front.reading)]
        if self._rear is not None and rear is not None:
            views.append(View("rear", rear, self._rear.reading))
        return diagnosis(self.say, self._verdict, views)

    def _publish_state(self) -> None:
        self._told_s = time.monotonic()
        message = DiagnosticArray(status=[self._status()])
        message.header.stamp = self.get_clock().now().to_msg()
        self._state.publish(message)


def main(args: list[str] | None = None) -> int:
    """Run the node until it is asked to end."""
    return run(SafetyStop, args)


if __name__ == "__main__":
    sys.exit(main())
