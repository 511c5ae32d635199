"""Driving by keys: what the keys ask for, and until when. Pure; times are monotonic seconds.

A terminal tells that a key is down only by its auto-repeat: nothing for the first half second,
then some thirty times a second, and only for the key that went down last. So a key that has just
been pressed counts as down for `FIRST_HOLD_S`, one that repeats for `NEXT_HOLD_S` after each
repetition, and the keys that were down before it go on with it: forward and then left is a curve
for as long as left is held.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

from robot.limits import SPEED, STEERING
from robot.words import STOP, DriveSetpoint

FIRST_HOLD_S = 0.6
"""The silence before a key begins to repeat: 0.25 to 0.6 s, by the settings of the desktop."""
NEXT_HOLD_S = 0.25
"""Between two repetitions there are 0.03 to 0.1 s; a slow line may swallow a few."""
STEP = 0.05
"""By which the limits change: m/s, and rad."""
LEAST = 0.05


class Move(Enum):
    """What a key asks for."""

    FORWARD = "forward"
    BACK = "back"
    LEFT = "left"
    RIGHT = "right"


DRIVES = {Move.FORWARD: 1, Move.BACK: -1}
STEERS = {Move.LEFT: 1, Move.RIGHT: -1}


@dataclass(frozen=True)
class TeleopLimits:
    """How fast and how sharp the keys drive."""

    speed_m_s: float = 0.2
    steering_rad: float = 0.3

    def faster(self, steps: int) -> TeleopLimits:
        """Return with so many steps more speed, or less, within what the robot may be asked."""
        return replace(self, speed_m_s=_stepped(self.speed_m_s, steps, SPEED.high))

    def sharper(self, steps: int) -> TeleopLimits:
        """Return with so many steps more steering, or less."""
        return replace(self, steering_rad=_stepped(self.steering_rad, steps, STEERING.high))


@dataclass(frozen=True)
class Teleop:
    """Which way is asked for by the keys that are down."""

    drive: int = 0
    """1 forward, -1 back."""
    steer: int = 0
    """1 left, -1 right."""
    newest: Move | None = None
    """The key that repeats."""
    until_s: float = 0.0
    """When it counts as up again."""

    def pressed(self, move: Move, at_s: float) -> Teleop:
        """Return with this key pressed, or repeated, at that time; times never go back."""
        now = self.at(at_s)
        repeats = now.newest is move
        hold_s = NEXT_HOLD_S if repeats else FIRST_HOLD_S
        drive, steer = DRIVES.get(move, now.drive), STEERS.get(move, now.steer)
        if not repeats and move in DRIVES and drive == now.drive:
            # Forward once more while it goes forward in a curve: straight on.
            steer = 0
        # A second press may not cut short what the first one may still be waiting for.
        until_s = max(now.until_s if repeats else 0.0, at_s + hold_s)
        return Teleop(drive, steer, move, until_s)

    def at(self, now_s: float) -> Teleop:
        """Return how it is at that time: nothing is down when the time of the keys is over."""
        return self if now_s < self.until_s else NOTHING

    def setpoint(self, limits: TeleopLimits) -> DriveSetpoint:
        """Return what is asked of the robot, m/s and rad."""
        if not (self.drive or self.steer):
            return STOP
        return DriveSetpoint(self.drive * limits.speed_m_s, self.steer * limits.steering_rad)


NOTHING = Teleop()


def _stepped(value: float, steps: int, most: float) -> float:
    """Return the value some whole steps further, without the dust of adding."""
    wanted = (round(value / STEP) + steps) * STEP
    return round(max(LEAST, min(most, wanted)), 2)
