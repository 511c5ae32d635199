"""A simulated robot: its serial devices, and the room that it drives in.

It creates pico, tof_front, tof_rear and lsc16 in `folder`: pseudo-terminals with the protocols of
the real devices. The drivers (chassis, tof_sonar, head_controller) use them like real ones. Behind
them is a simulated room with walls and boxes. Parameters cause faults at any time:
`pico:=unplugged` pulls a cable, `pico:=fine` puts it back. /map is a map of the room, /mock/pose
the true pose of the robot, and /mock/motors the true motion of its wheels, which a real robot could
not report.
"""

from __future__ import annotations

import math
import os
import sys
import time
from pathlib import Path

from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid

from nodes.parts.node import LessonNode, NodeUsageError
from nodes.parts.parameters import Choice, Number, Setting, Text, Whole
from nodes.parts.qos import DEPTH, LATCHED
from nodes.parts.runner import run
from nodes.simulated.device_fault import FAULTS, FINE, NOISE, SILENT, SLOW, UNPLUGGED, FaultyLine
from nodes.simulated.map_message import occupancy_grid
from nodes.simulated.motors import MockMotors
from nodes.simulated.pseudo_terminal import PseudoSerial
from robot.topics import MAP, MOCK_POSE
from robot.wire.tfluna import TofFrame, encode
from robot.world.grid import grid_of
from robot.world.pico import SimulatedPico
from robot.world.servos import SimulatedServos
from robot.world.world import STEP_S, SimulatedSonar, World
from space.transform import quaternion_from_rpy
from text.i18n import N_
from text.os_words import os_reason
from text.run_path import run_path

DEVICES = ("pico", "tof_front", "tof_rear", "lsc16")
_BEHIND_S = 0.5
"""After a longer pause the simulation does not catch up."""
_POSE_EVERY = 5

_STARTED = N_("The simulated robot is in {folder}: {devices}")
_NO_FOLDER = N_("cannot make devices in {folder}: {problem}; set the parameter folder")
_FAULT = {
    FINE: N_("{device} works again"),
    UNPLUGGED: N_("{device} is now unplugged"),
    SILENT: N_("{device} is now silent"),
    NOISE: N_("{device} now has noise on its line"),
    SLOW: N_("{device} is now slow"),
}
_COLLISION = N_("The robot ran into something (number {count})")


def _fault(device: str, about: str) -> Setting:
    return Choice(device, FINE, about, choices=FAULTS)


class MockRobot(LessonNode):
    """Steps the simulation, and carries bytes between it and the pseudo-terminals."""

    NAME = "mock_robot"
    SETTINGS = (
        Text("folder", "", "Where the devices appear; empty: Deck's own", True, may_be_empty=True),
        _fault("pico", N_("Fault of the Pico")),
        _fault("tof_front", N_("Fault of the front sonar")),
        _fault("tof_rear", N_("Fault of the rear sonar")),
        _fault("lsc16", N_("Fault of the servo controller")),
        Choice("stalled", "none", "Motors that do not turn", choices=("none", "left", "right", "both")),
        Choice(
            "driver_fault", "none", "Motor drivers that report a fault", choices=("none", "left", "right", "both")
        ),
        Number("battery", 7.4, "Voltage of the battery", low=0.0, high=30.0, unit="V"),
        Number("noise", 0.01, "Standard deviation of the sonars", high=1.0, unit="m", fixed=True),
        Number("dropout", 0.01, "Share of readings without a distance", high=1.0, fixed=True),
        Whole("seed", 0, "Seed of the random numbers", high=2**31, fixed=True),
    )

    def __init__(self) -> None:
        super().__init__()
        noise_m, dropout = self.number("noise"), self.number("dropout")
        self._world = World(
            seed=int(self.number("seed")),
            front=SimulatedSonar(noise_m=noise_m, dropout=dropout),
            rear=SimulatedSonar(forward=False, noise_m=noise_m, dropout=dropout),
        )
        self._pico, self._servos = SimulatedPico(self._world), SimulatedServos()
        folder = Path(self.text("folder") or run_path(os.environ) / "devices").expanduser()
        self._lines = self._make_lines(folder)
        self._told: dict[str, str] = dict.fromkeys(DEVICES, FINE)
        self._collisions = 0
        self._motors = MockMotors(self, self._world)
        self._publisher = self.create_publisher(PoseStamped, MOCK_POSE, DEPTH)
        self._map_publisher = self.create_publisher(OccupancyGrid, MAP, LATCHED)
        now = self.get_clock().now().to_msg()
        self._map_publisher.publish(occupancy_grid(grid_of(self._world.room), now))
        self.parameters_changed()
        self._now_s = time.monotonic()
        self.every(STEP_S, self._tick)
        self.say.info(_STARTED, folder=folder, devices=", ".join(DEVICES))

    def parameters_changed(self) -> None:
        """Cause or repair the faults."""
        for device in DEVICES:
            fault = self.text(device)
            if fault != self._told[device]:
                self._told[device] = fault
                self._lines[device].set_fault(fault)
                self.say.warn(_FAULT[fault], device=device)
        sides = {"none": "", "left": "L", "right": "R", "both": "LR"}
        stalled = sides[self.text("stalled")]
        self._world.stalled = "L" in stalled, "R" in stalled
        self._pico.faults = frozenset(sides[self.text("driver_fault")])
        self._pico.battery_v = self._servos.battery_v = self.number("battery")

    def before_end(self) -> None:
        for line in self._lines.values():
            line.close()

    def _make_lines(self, folder: Path) -> dict[str, FaultyLine]:
        try:
            # The parent folder is Deck's own, which others cannot access.
            folder.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            folder.mkdir(mode=0o700, exist_ok=True)
            return {device: FaultyLine(PseudoSerial(folder / device), seed) for seed, device in enumerate(DEVICES)}
        except OSError as error:
            raise NodeUsageError(_NO_FOLDER, folder=folder, problem=os_reason(error)) from None

    def _tick(self) -> None:
        self._pico.feed(self._lines["pico"].read())
        for device in ("tof_front", "tof_rear"):
            self._lines[device].read()
        now_s = time.monotonic()
        if now_s - self._now_s > _BEHIND_S:
            self._now_s = now_s - _BEHIND_S
        while now_s - self._now_s >= STEP_S:
            self._now_s += STEP_S
            self._step()
        self._lines["lsc16"].write(self._servos.feed(self._lines["lsc16"].read()), now_s)
        if self._world.collisions > self._collisions:
            self._collisions = self._world.collisions
            self.say.warn(_COLLISION, count=self._collisions)

    def _step(self) -> None:
        self._lines["pico"].write(self._pico.step(), self._now_s)
        self._world.step()
        self._motors.step()
        self._servos.advance(STEP_S)
        for device, metres in zip(("tof_front", "tof_rear"), self._world.read_sonars(), strict=True):
            self._lines[device].write(encode(_tof_frame(metres)), self._now_s)
        if self._world.steps % _POSE_EVERY == 0:
            self._publish_pose()

    def _publish_pose(self) -> None:
        message = PoseStamped()
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = "odom"
        place, turn = message.pose.position, message.pose.orientation
        place.x, place.y = self._world.pose.x_m, self._world.pose.y_m
        heading_rad = self._world.pose.heading_rad
        turn.x, turn.y, turn.z, turn.w = quaternion_from_rpy(0.0, 0.0, heading_rad)
        self._publisher.publish(message)


def _tof_frame(metres: float) -> TofFrame:
    """Return the frame that a TF-Luna would send."""
    if metres == math.inf:
        return TofFrame(0, 50, 30.0)
    if math.isnan(metres):
        return TofFrame(0, 65535, 30.0)
    return TofFrame(10 if metres < 0 else round(metres * 100), 1000, 30.0)


def main(args: list[str] | None = None) -> int:
    """Run the node until it is asked to end."""
    return run(MockRobot, args)


if __name__ == "__main__":
    sys.exit(main())
