"""A simulated robot: its serial devices, and the room that it drives in.

It creates pico, tof_front, tof_rear and lsc16 in `folder`: pseudo-terminals with the protocols of
the real devices. The drivers (chassis, tof_sonar, head_controller) use them like real ones. Behind
them is a simulated room with walls and boxes. Parameters cause faults at any time:
`pico:=unplugged` pulls a cable, `pico:=fine` puts it back. /map is a map of the room, /mock/pose
the true pose of the robot, and /mock/motors the true motion of its wheels, which a real robot could
not report.
"""

from __future__ import annotations

import array
import math
import os
import time
from pathlib import Path

from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import JointState

from nodes.parts.node import DEPTH, LATCHED, Choice, LessonNode, NodeUsageError, Number, Text, Whole
from nodes.parts.odometry import ODOM, turned
from nodes.parts.runner import run
from nodes.simulated.devices import FAULTS, FINE, NOISE, SILENT, SLOW, UNPLUGGED, FaultyLine, PseudoSerial
from robot.joints import DRIVE_JOINTS
from robot.topics import MAP, MOCK_MOTORS, MOCK_POSE
from robot.wire.tfluna import TofFrame, encode
from robot.world.boards import SimulatedPico, SimulatedServos
from robot.world.grid import CellMap, grid_of
from robot.world.world import STEP_S, SimulatedSonar, World
from text.i18n import N_
from text.os_words import os_reason
from text.run_path import run_path


def occupancy_grid(grid: CellMap, stamp: Time) -> OccupancyGrid:
    """Put a grid into a message with this stamp."""
    message = OccupancyGrid()
    # The simulated robot starts at the origin of its odometry, so one frame is enough.
    message.header.frame_id = ODOM
    message.header.stamp = message.info.map_load_time = stamp
    message.info.resolution = grid.cell_m
    message.info.height, message.info.width = grid.cells.shape
    message.info.origin.position.x = grid.x_m
    message.info.origin.position.y = grid.y_m
    message.info.origin.orientation.w = 1.0
    message.data = array.array("b", grid.cells.tobytes())
    return message


_EVERY = 2


class MockMotors:
    """Publishes 50 times a second, while somebody is subscribed.

    `velocity` is the speed of each wheel in rad/s, `position` its total rotation in rad, which
    includes even the smallest motion between two messages. `effort` is the highest speed that the
    motor was driven at since the last message, rad/s, 0 while it is off. The last joint is the
    steering.
    """

    def __init__(self, node: LessonNode, world: World) -> None:
        self._node, self._world = node, world
        self._turned = [0.0, 0.0]
        self._driven = [0.0, 0.0]
        self._steps = 0
        self._publisher = node.create_publisher(JointState, MOCK_MOTORS, DEPTH)

    def step(self) -> None:
        """Add the motion of one `STEP_S`."""
        wheels, asked = self._world.wheels, self._world.asked
        self._turned[0] += wheels.left_rad_s * STEP_S
        self._turned[1] += wheels.right_rad_s * STEP_S
        self._driven[0] = max(self._driven[0], asked.left_rad_s, key=abs)
        self._driven[1] = max(self._driven[1], asked.right_rad_s, key=abs)
        self._steps += 1
        if self._steps % _EVERY == 0:
            if self._publisher.get_subscription_count():
                self._publish()
            self._driven = [0.0, 0.0]

    def _publish(self) -> None:
        wheels = self._world.wheels
        message = JointState(name=list(DRIVE_JOINTS))
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.position = [*self._turned, wheels.steering_rad]
        message.velocity = [wheels.left_rad_s, wheels.right_rad_s, 0.0]
        message.effort = [*self._driven, 0.0]
        self._publisher.publish(message)


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


def _fault(about: str) -> Choice:
    return Choice(FINE, about, choices=FAULTS)


class MockRobot(LessonNode):
    """Steps the simulation, and carries bytes between it and the pseudo-terminals."""

    NAME = "mock_robot"
    folder = Text("", "Where the devices appear; empty: Deck's own", fixed=True, may_be_empty=True)
    pico = _fault(N_("Fault of the Pico"))
    tof_front = _fault(N_("Fault of the front sonar"))
    tof_rear = _fault(N_("Fault of the rear sonar"))
    lsc16 = _fault(N_("Fault of the servo controller"))
    stalled = Choice("none", "Motors that do not turn", choices=("none", "left", "right", "both"))
    driver_fault = Choice("none", "Motor drivers that report a fault", choices=("none", "left", "right", "both"))
    battery = Number(7.4, "Voltage of the battery", low=0.0, high=30.0, unit="V")
    noise = Number(0.01, "Standard deviation of the sonars", high=1.0, unit="m", fixed=True)
    dropout = Number(0.01, "Share of readings without a distance", high=1.0, fixed=True)
    seed = Whole(0, "Seed of the random numbers", high=2**31, fixed=True)

    def __init__(self) -> None:
        super().__init__()
        noise_m, dropout = self.noise, self.dropout
        self._world = World(
            seed=self.seed,
            front=SimulatedSonar(noise_m=noise_m, dropout=dropout),
            rear=SimulatedSonar(forward=False, noise_m=noise_m, dropout=dropout),
        )
        self._pico, self._servos = SimulatedPico(self._world), SimulatedServos()
        folder = Path(self.folder or run_path(os.environ) / "devices").expanduser()
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
            fault = self.values[device]
            if fault != self._told[device]:
                self._told[device] = fault
                self._lines[device].set_fault(fault)
                self.say.warn(_FAULT[fault], device=device)
        sides = {"none": "", "left": "L", "right": "R", "both": "LR"}
        stalled = sides[self.stalled]
        self._world.stalled = "L" in stalled, "R" in stalled
        self._pico.faults = frozenset(sides[self.driver_fault])
        self._pico.battery_v = self._servos.battery_v = self.battery

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
        message.header.frame_id = ODOM
        message.pose.position.x, message.pose.position.y = self._world.pose.x_m, self._world.pose.y_m
        message.pose.orientation = turned(self._world.pose.heading_rad)
        self._publisher.publish(message)


def _tof_frame(metres: float) -> TofFrame:
    """Return the frame that a TF-Luna would send."""
    if metres == math.inf:
        return TofFrame(0, 50, 30.0)
    if math.isnan(metres):
        return TofFrame(0, 65535, 30.0)
    return TofFrame(10 if metres < 0 else round(metres * 100), 1000, 30.0)


if __name__ == "__main__":
    raise SystemExit(run(MockRobot))
