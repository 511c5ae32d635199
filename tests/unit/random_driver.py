"""Somebody who drives a simulated robot at random through the gate, with all kinds of trouble."""

from __future__ import annotations

import math
import random

from robot.kinematics import wheel_speeds
from robot.motion.odometry import Pose
from robot.safety.distance import Reading, SafetyZone, Shares, gate, range_state, share, where
from robot.words import STOP, DriveSetpoint
from robot.world.world import STEP_S, Box, Room, Wheels, World

CONTROL_STEPS = 5
"""20 commands a second."""
CARRIED_AFTER_S = 20.0
"""Who has got nowhere for so long is boxed in before and behind: a person carries it away."""


def drive(world: World, speed: float, steering: float = 0.0) -> None:
    wheels = wheel_speeds(speed, steering)
    radius = world.body.wheel_radius_m
    world.asked = Wheels(wheels.left_m_s / radius, wheels.right_m_s / radius, steering)


def let_pass(world: World, seconds: float) -> None:
    """Let so many seconds pass in the simulated room."""
    for _ in range(round(seconds / STEP_S)):
        world.step()


def on_free_floor(room: Room, x_m: float, y_m: float) -> bool:
    """Whether a point lies between the walls and outside all boxes."""

    def covers(box: Box) -> bool:
        cos, sin = math.cos(box.heading_rad), math.sin(box.heading_rad)
        east, north = x_m - box.x_m, y_m - box.y_m
        along, across = cos * east + sin * north, cos * north - sin * east
        return abs(along) <= box.length_m / 2 and abs(across) <= box.width_m / 2

    return covers(room.walls) and not any(map(covers, room.boxes))


class RandomDriver:
    """Changes its mind, sends nonsense, and hears its sonars only as the gate does.

    Sonars fall silent for a while, motors stall, commands are noisy and now and then no numbers.
    """

    def __init__(self, world: World, seed: int, zone: SafetyZone | None) -> None:
        """`zone` is what the gate goes by; None: there is no gate."""
        self.world, self.dice, self.zone = world, random.Random(seed), zone
        self.avoidable = 0
        """Collisions that a stop could have avoided."""
        self.driven_m = 0.0
        self._asked = STOP
        self._readings = [(math.nan, -1.0), (math.nan, -1.0)]
        self._silent_until_s = self._stalled_until_s = 0.0

    def drive_for(self, seconds: float) -> None:
        for _ in range(round(seconds / CARRIED_AFTER_S)):
            before_m = self.driven_m
            for _ in range(round(CARRIED_AFTER_S / STEP_S) // CONTROL_STEPS):
                self._round()
            if self.driven_m - before_m < 0.2:
                self._carry()

    @property
    def now_s(self) -> float:
        return self.world.steps * STEP_S

    def _round(self) -> None:
        """One look, one command, and the time until the next."""
        world, dice = self.world, self.dice
        self._trouble()
        if self.now_s >= self._silent_until_s:
            self._readings = [(metres, self.now_s) for metres in world.read_sonars()]
        if dice.random() < 0.02:
            speed = dice.choice([0.5, 0.3, -0.3, -0.5, 0.0])
            self._asked = DriveSetpoint(speed, dice.uniform(-0.5, 0.5))
        noisy = DriveSetpoint(self._asked.speed_m_s + dice.gauss(0, 0.02), self._asked.steering_rad)
        if dice.random() < 0.005:
            noisy = DriveSetpoint(math.nan, 0.0)
        command = noisy if self.zone is None else self._gated(noisy, self.zone)
        if math.isfinite(command.speed_m_s):
            drive(world, max(-0.5, min(0.5, command.speed_m_s)), command.steering_rad)
        self._pass()

    def _trouble(self) -> None:
        now_s, dice = self.now_s, self.dice
        if dice.random() < 0.002:
            self._silent_until_s = now_s + dice.uniform(0.1, 1.0)
        if dice.random() < 0.0005:
            self._stalled_until_s = now_s + dice.uniform(0.1, 2.0)
            self.world.stalled = dice.choice([(True, False), (False, True), (True, True)])
        if now_s >= self._stalled_until_s:
            self.world.stalled = (False, False)

    def _gated(self, command: DriveSetpoint, zone: SafetyZone) -> DriveSetpoint:
        front, rear = (Reading(m, self.now_s - then) for m, then in self._readings)
        ahead = range_state(front, zone.critical_m, zone.stale_after_s)
        behind = range_state(rear, zone.critical_m, zone.stale_after_s)
        shares = Shares(share(front, zone), share(rear, zone))
        return gate(command, where(ahead, behind, False), shares)

    def _carry(self) -> None:
        """Put the robot down anywhere on the free floor."""
        dice = self.dice
        while True:
            pose = Pose(dice.uniform(-0.5, 3.5), dice.uniform(-1.5, 1.5), dice.uniform(-3, 3))
            if on_free_floor(self.world.room, pose.x_m, pose.y_m) and self._put(pose):
                return

    def _put(self, pose: Pose) -> bool:
        """Move the robot elsewhere; return False if it would touch something there."""
        world = self.world
        if world.room.touches(world.body.outline(pose)):
            return False
        world.pose, world._free_m, world._since_hit_m = pose, 0.0, math.inf
        return True

    def _pass(self) -> None:
        world = self.world
        for _ in range(CONTROL_STEPS):
            speed, before, pose = world.speed_m_s, world.collisions, world.pose
            world.step()
            self.driven_m += math.dist((pose.x_m, pose.y_m), (world.pose.x_m, world.pose.y_m))
            if world.collisions > before:
                sonar = world.front if speed > 0 else world.rear
                # What it ran into stood before its sonar, and not beside the beam.
                ahead_m = sonar.true_m(world.room, world.body, world.pose)
                self.avoidable += ahead_m < 0.02 + abs(speed) * STEP_S
