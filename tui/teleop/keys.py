"""Driving with keys: what the keys ask for, until when, and where that goes. Pure; times are monotonic seconds.

A terminal shows that a key is down only by its auto-repeat: nothing for the first half second, then
about thirty times a second, and only for the key pressed last. So a key that has just been pressed
counts as down for `FIRST_HOLD_S`, and one that repeats for `NEXT_HOLD_S` after each repetition.
Keys that were already down stay down with it: forward and then left is a curve for as long as left
is held.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from robot.limits import SPEED, STEERING
from robot.topics import DRIVE, DRIVE_SAFE, DRIVE_TELEOP
from robot.words import STOP, DriveSetpoint
from tui.teleop.actions import Move

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import GraphUpdate, Value

FIRST_HOLD_S = 0.6
"""Delay before a key repeats: 0.25 to 0.6 s, depending on the settings of the desktop."""
NEXT_HOLD_S = 0.25
"""Repetitions come every 0.03 to 0.1 s; a slow line may lose a few."""
STEP = 0.05
"""Step by which the limits change, in m/s and rad."""
LEAST = 0.05


DRIVES = {Move.FORWARD: 1, Move.BACK: -1}
STEERS = {Move.LEFT: 1, Move.RIGHT: -1}


@dataclass(frozen=True)
class TeleopLimits:
    """The speed and steering of the keys."""

    speed_m_s: float = 0.2
    steering_rad: float = 0.3

    def faster(self, steps: int) -> TeleopLimits:
        """Return these limits with the speed changed by some steps, within the robot's range."""
        return replace(self, speed_m_s=_stepped(self.speed_m_s, steps, SPEED.high))

    def sharper(self, steps: int) -> TeleopLimits:
        """Return these limits with the steering changed by some steps."""
        return replace(self, steering_rad=_stepped(self.steering_rad, steps, STEERING.high))


@dataclass(frozen=True)
class Teleop:
    """The motion asked for by the keys that are down."""

    drive: int = 0
    """1 forward, -1 back."""
    steer: int = 0
    """1 left, -1 right."""
    newest: Move | None = None
    """The key that is repeating."""
    until_s: float = 0.0
    """When it counts as released."""

    def pressed(self, move: Move, at_s: float) -> Teleop:
        """Return the state with this key pressed or repeated at that time; times never decrease."""
        now = self.at(at_s)
        repeats = now.newest is move
        hold_s = NEXT_HOLD_S if repeats else FIRST_HOLD_S
        drive, steer = DRIVES.get(move, now.drive), STEERS.get(move, now.steer)
        if not repeats and move in DRIVES and drive == now.drive:
            # A second press of forward while driving forward in a curve means straight on.
            steer = 0
        # A second press must not shorten the wait for the repetition of the first one.
        until_s = max(now.until_s if repeats else 0.0, at_s + hold_s)
        return Teleop(drive, steer, move, until_s)

    def at(self, now_s: float) -> Teleop:
        """Return the state at that time: nothing is down once the time of the keys is over."""
        return self if now_s < self.until_s else NOTHING

    def setpoint(self, limits: TeleopLimits) -> DriveSetpoint:
        """Return the resulting setpoint, m/s and rad."""
        if not (self.drive or self.steer):
            return STOP
        return DriveSetpoint(self.drive * limits.speed_m_s, self.steer * limits.steering_rad)


NOTHING = Teleop()


def _stepped(value: float, steps: int, most: float) -> float:
    """Return the value changed by whole steps, without rounding errors adding up."""
    wanted = (round(value / STEP) + steps) * STEP
    return round(max(LEAST, min(most, wanted)), 2)


DRIVE_TYPE = "ackermann_msgs/msg/AckermannDriveStamped"
RATE_HZ = 20.0
"""Rate of the commands while a key is held."""
FRAME = "base_link"


class Route(NamedTuple):
    """The topic that the keys publish to."""

    topic: str = ""
    """Empty: nobody listens."""
    gated: bool = False
    """Whether a gate stands between it and the wheels."""


def route(update: GraphUpdate | None) -> Route:
    """Return the topic that has a subscriber, preferring that of the gate."""
    rows = {row.name: row for row in update.topics} if update is not None else {}
    safe = rows.get(DRIVE_SAFE)
    gated = safe is not None and safe.publishers > 0
    for topic in (DRIVE_TELEOP, DRIVE):
        row = rows.get(topic)
        if row is not None and row.subscribers:
            return Route(topic, gated or topic == DRIVE_TELEOP)
    return Route("", gated)


def command(setpoint: DriveSetpoint) -> Mapping[str, Value]:
    """Return an AckermannDriveStamped as a tree."""
    return {
        "header": {"frame_id": FRAME},
        "drive": {"speed": setpoint.speed_m_s, "steering_angle": setpoint.steering_rad},
    }
