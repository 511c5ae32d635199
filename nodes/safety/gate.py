"""The gate: relays the commands of the ranked sources to /drive_safe, as far as they are allowed.

A command that makes the robot slower goes out at once, in the callback that caused it; the current
allowed command is repeated with every tick, so that its receivers notice a dead gate.
"""

from __future__ import annotations

import functools
import math
import time
from collections.abc import Callable

from ackermann_msgs.msg import AckermannDriveStamped

from nodes.parts.commands import (
    LAST_STOP,
    SLOWEST,
    CommandRefusals,
    FirstHeard,
    SolePublisher,
    StallDetector,
    from_message,
    to_message,
)
from nodes.parts.node import DEPTH, LessonNode
from nodes.safety import words
from nodes.safety.state import GateSnapshot
from robot.limits import SPEED, STEERING
from robot.safety.distance import Shares, Verdict, allowed, gate
from robot.safety.sources import SourceCommand, Sources
from robot.topics import DRIVE_SAFE, DRIVE_TELEOP
from robot.words import STOP, DriveSetpoint

_FINEST_M_S = 0.01
"""A smaller reduction of speed waits for the next tick."""
_REMEMBER_IGNORED_S = 1.0
_HOLDING = (Verdict.EMERGENCY_STOP, Verdict.STARTING)
"""After these every source has to send a new command."""


class CommandGate:
    """Subscribes to the sources of `node`, and publishes what passes."""

    def __init__(self, node: LessonNode, look: Callable[[], None], reason: Callable[[], str]) -> None:
        """Call `look`, which calls `rule`, before each command is judged.

        `reason` returns in words why something was stopped.
        """
        self._node, self._look, self._reason = node, look, reason
        self._verdict, self._shares = Verdict.STARTING, Shares(0.0, 0.0)
        names = node.values["sources"].replace(",", " ").split()
        self._sources = Sources(names, node.values["max_age_s"], {DRIVE_TELEOP})
        self._driver = self._ignored = ""
        self._ignored_s = -math.inf
        self._sent = STOP
        self._stalls = StallDetector()
        self._refusals = CommandRefusals(node)
        self._publisher = node.create_publisher(AckermannDriveStamped, DRIVE_SAFE, DEPTH)
        SolePublisher(node, self._publisher.topic_name, own=True, others=SLOWEST)
        self._arrivals = FirstHeard()
        for name in names:
            hear = functools.partial(self._hear, name)
            node.create_subscription(AckermannDriveStamped, name, hear, DEPTH)

    @property
    def starting(self) -> bool:
        """Whether it has just started and may not know of an emergency stop yet."""
        return self._arrivals.quiet_s < float(self._node.values["settle_s"])

    def held_up(self) -> bool:
        """Whether to ignore messages now, as they may have waited too long."""
        ages_s = (self._node.values["max_age_s"] or math.inf, self._node.values["stale_after_s"])
        held_up = self._stalls.lasted(min(ages_s) + 1.0 / self._node.values["rate"])
        if held_up:
            self._node.say.warn(words.HELD_UP, every_s=1.0)
        return held_up

    def rule(self, verdict: Verdict, shares: Shares) -> None:
        """Apply a new judgement; at once if it demands less speed."""
        self._verdict, self._shares = verdict, shares
        if verdict in _HOLDING:
            self._sources.forget()
        order = self._sources.driving(time.monotonic())
        if _is_calmer(self._passed(order), self._sent):
            self._pass_on(order)

    def tick(self) -> None:
        """Drop a command that is too old, and repeat what is allowed."""
        now_s = time.monotonic()
        self._sources.let_age(self._node.values["max_age_s"], now_s)
        self._pass_on(self._sources.driving(now_s))

    def stop(self) -> None:
        self._send(STOP)
        self._publisher.wait_for_all_acked(LAST_STOP)

    def snapshot(self) -> GateSnapshot:
        """Return its current state."""
        now_s = time.monotonic()
        order = self._sources.driving(now_s)
        asked_m_s = order.setpoint.speed_m_s if order else 0.0
        recently = now_s - self._ignored_s < _REMEMBER_IGNORED_S
        return GateSnapshot(
            order.source if order else "",
            self._ignored if recently and order else "",
            asked_m_s,
            allowed(asked_m_s, self._verdict, self._shares),
            order.age_s(now_s) if order else None,
            self._refusals.recent,
        )

    def _hear(self, source: str, message: AckermannDriveStamped) -> None:
        # Read first: if this process is held up after this, the command will count as old.
        arrived_s = time.monotonic()
        if self.held_up() or self._stalls.kept_waiting(message.header.stamp):
            return
        self._arrivals.hear(source)
        self._look()
        asked = self._granted(source, message)
        if self._verdict in _HOLDING:
            if asked.speed_m_s:
                self._tell_cut(asked)
            return
        driving = self._sources.hear(source, asked, arrived_s)
        if driving.source == source:
            self._pass_on(self._sources.driving(time.monotonic()))
            return
        self._ignored, self._ignored_s = source, time.monotonic()
        self._node.say.warn(words.IGNORED, every_s=2.0, ignored=source, source=driving.source)

    def _granted(self, source: str, message: AckermannDriveStamped) -> DriveSetpoint:
        """Return the command, a stop if it is refused."""
        asked = from_message(message)
        refused = self._refusals.beyond(
            source, (asked.speed_m_s, SPEED), (asked.steering_rad, STEERING)
        ) or self._refusals.untimely(source, message.header.stamp, self._sources.limit_s(source))
        return STOP if refused else asked

    def _passed(self, order: SourceCommand | None) -> DriveSetpoint:
        return gate(order.setpoint if order else STOP, self._verdict, self._shares)

    def _pass_on(self, order: SourceCommand | None) -> None:
        passed = self._passed(order)
        if order is None and self._sent.speed_m_s and self._verdict not in _HOLDING:
            seconds = self._sources.limit_s(self._driver)
            self._node.say.warn(words.COMMAND_OLD, seconds=seconds)
        if order is not None and order.setpoint.speed_m_s and not passed.speed_m_s:
            self._tell_cut(order.setpoint)
            self._sources.correct(order, passed)
        driver = order.source if order else ""
        if driver and driver != self._driver:
            self._node.say.info(words.DRIVES, source=driver)
        self._driver = driver
        self._send(passed)

    def _tell_cut(self, asked: DriveSetpoint) -> None:
        self._node.say.warn(
            words.COMMAND_CUT, every_s=1.0, speed=asked.speed_m_s, steering=asked.steering_rad, reason=self._reason()
        )

    def _send(self, passed: DriveSetpoint) -> None:
        self._sent = passed
        self._publisher.publish(to_message(self._node, passed))


def _is_calmer(new: DriveSetpoint, old: DriveSetpoint) -> bool:
    """Whether the new command stops or slows the motion of the old one."""
    if new.speed_m_s == 0 or new.speed_m_s * old.speed_m_s < 0:
        return old.speed_m_s != 0
    return abs(new.speed_m_s) < abs(old.speed_m_s) - _FINEST_M_S
