"""The simulated room: rays, motion, collisions, devices, maps and pictures of it."""

from __future__ import annotations

import importlib.util
import math
import random
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.motion.odometry import Pose
from robot.safety.distance import SafetyZone
from robot.wire.pico import Drive, Halt, Hello, Message, PicoDecoder, Release, Telemetry, encode
from robot.world.boards import SimulatedPico
from robot.world.world import LIVING_ROOM, Body, Box, Room, SimulatedSonar, Wheels, World
from tests.unit.random_driver import RandomDriver, drive, let_pass

EMPTY = Room(Box(0.0, 0.0, 10.0, 10.0))
small = st.floats(-4.0, 4.0)
angles = st.floats(-math.pi, math.pi)
orders = st.lists(st.tuples(st.floats(-30, 30), st.floats(-30, 30), st.floats(-1, 1)), max_size=6)


# ---------------------------------------------------------------- the room


@given(small, small, angles)
def test_a_ray_ends_at_a_wall(x: float, y: float, heading: float) -> None:
    distance = EMPTY.distance(x, y, heading)
    end = x + distance * math.cos(heading), y + distance * math.sin(heading)
    assert max(map(abs, end)) == pytest.approx(5.0)
    assert EMPTY.clearance(x, y) <= distance + 1e-9
    assert EMPTY.clearance(x, y) == pytest.approx(5.0 - max(abs(x), abs(y)))


def test_a_ray_sees_the_nearest_box() -> None:
    room = Room(Box(0, 0, 10, 10), [Box(2, 0, 1, 1), Box(4, 0, 0.5, 0.5)])
    assert room.distance(0, 0, 0) == pytest.approx(1.5)
    assert room.distance(0, 0, math.pi) == pytest.approx(5.0)
    assert room.distance(0, 0, math.pi / 4) == pytest.approx(5 * math.sqrt(2))


# ---------------------------------------------------------------- the robot


def test_it_drives_straight_at_the_speed_asked_for_after_a_lag() -> None:
    world = World(EMPTY)
    drive(world, 0.3)
    let_pass(world, world.body.motor_lag_s)
    assert world.speed_m_s == pytest.approx(0.3 * (1 - math.exp(-1)), abs=0.01)
    let_pass(world, 5.0)
    assert world.speed_m_s == pytest.approx(0.3, abs=1e-4)
    assert world.pose.x_m == pytest.approx(0.3 * (5.0), abs=0.03)
    assert world.pose.y_m == 0


def test_it_turns_on_the_circle_of_the_differential() -> None:
    world = World(EMPTY)
    drive(world, 0.3, 0.5)
    let_pass(world, 2.0)
    far = [world.pose]
    for _ in range(2):
        let_pass(world, 2.0)
        far.append(world.pose)
    # Three points of a circle of R = 0.4576 m.
    (ax, ay), (bx, by), (cx, cy) = ((pose.x_m, pose.y_m) for pose in far)
    a, b, c = (math.dist((bx, by), (cx, cy)), math.dist((ax, ay), (cx, cy)), math.dist((ax, ay), (bx, by)))
    area = abs((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)) / 2
    assert a * b * c / (4 * area) == pytest.approx(0.4576, abs=0.001)


def test_a_stop_stops_within_centimetres_and_for_good() -> None:
    world = World(EMPTY)
    drive(world, 0.5)
    let_pass(world, 2.0)
    before = world.pose.x_m
    drive(world, 0.0)
    let_pass(world, 0.4)
    assert world.speed_m_s == 0
    assert world.pose.x_m - before < 0.06


def test_it_stands_at_the_wall_and_can_back_off() -> None:
    world = World(EMPTY, pose=Pose(4.0, 0.0))
    drive(world, 0.5)
    let_pass(world, 5.0)
    assert world.collisions == 1
    nose = world.pose.x_m + world.body.length_m - world.body.behind_m
    assert nose == pytest.approx(5.0, abs=0.02)
    drive(world, -0.3)
    let_pass(world, 1.0)
    assert world.pose.x_m < 4.6
    assert world.collisions == 1


@given(orders)
def test_it_is_never_inside_of_anything(sent: list[tuple[float, float, float]]) -> None:
    world = World()
    for left, right, steering in sent:
        world.asked = Wheels(left, right, steering)
        let_pass(world, 1.0)
        assert not world.room.touches(world.body.outline(world.pose))


@given(st.tuples(st.floats(), st.floats(), st.floats()))
def test_orders_that_are_no_numbers_do_no_harm(order: tuple[float, float, float]) -> None:
    world = World()
    world.asked = Wheels(*order)
    let_pass(world, 0.3)
    assert world.pose.is_finite


# ---------------------------------------------------------------- the sonars


def test_a_sonar_tells_what_is_before_it_and_what_it_cannot() -> None:
    dice, body = random.Random(1), Body()
    exact = SimulatedSonar(noise_m=0, dropout=0)
    assert exact.read(EMPTY, body, Pose(4, 0), dice) == pytest.approx(0.7)
    assert replace(exact, forward=False).read(EMPTY, body, Pose(-4, 0), dice) == pytest.approx(0.95)
    assert exact.read(EMPTY, body, Pose(4.6, 0), dice) == -math.inf
    assert exact.read(EMPTY, body, Pose(-4, 0), dice) == math.inf
    assert math.isnan(replace(exact, dropout=1.0).read(EMPTY, body, Pose(), dice))


# ---------------------------------------------------------------- through the gate


def test_minutes_among_boxes_have_no_collision_that_a_stop_could_have_avoided() -> None:
    driver = RandomDriver(World(LIVING_ROOM, seed=3), seed=4, zone=SafetyZone(0.3, 0.0, 0.3))
    driver.drive_for(180.0)
    assert driver.now_s == pytest.approx(180.0)
    assert driver.driven_m > 10
    assert driver.avoidable == 0


def test_without_the_gate_the_same_driver_does_run_into_things() -> None:
    driver = RandomDriver(World(LIVING_ROOM, seed=3), seed=4, zone=None)
    driver.drive_for(60.0)
    assert driver.avoidable > 0


PICO2 = Path(__file__).parents[3] / "firmware" / "pico2"


def load(name: str) -> Any:
    spec = importlib.util.spec_from_file_location(name, PICO2 / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    finally:
        if name != "protocol":
            del sys.modules[name]
    return module


class Board:
    """What control.py needs, with a clock by hand."""

    def __init__(self) -> None:
        self.ms, self.battery, self.left_fault = 0, 7400, False
        self.out, self.moves = b"", False

    def now_ms(self) -> int:
        return self.ms

    def since_ms(self, then: int) -> int:
        return self.ms - then

    def write(self, data: bytes) -> None:
        self.out += data

    def drive(self, left: int, right: int) -> None:
        self.moves = bool(left or right)

    def brake(self) -> None:
        self.moves = False

    off = brake

    def steer(self, us: int) -> None:
        pass

    def faults(self) -> tuple[bool, bool]:
        return self.left_fault, False

    def currents_ma(self) -> tuple[int, int]:
        return 0, 0

    def battery_mv(self) -> int:
        return self.battery

    def counts(self) -> None:
        return None


@pytest.mark.parametrize("seed", range(4))
def test_the_simulated_pico_does_what_the_firmware_does(seed: int) -> None:
    dice = random.Random(seed)
    load("protocol")
    board = Board()
    firmware = load("control").Control(board, load("config"))
    world = World()
    pico = SimulatedPico(world)
    decoder, other = PicoDecoder(), PicoDecoder()
    sequence = 0
    for _ in range(600):
        octets = b""
        if dice.random() < 0.4:
            sequence = (sequence + dice.choice([1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 40_000])) % 65536
            said: list[Message] = [
                Drive(sequence, 0, 0, 0.1),
                Drive(sequence, 5, 4, -0.1),
                Drive(sequence, 18, 4, -0.1),
                Drive(sequence, 5, 4, -0.6),
                Hello(sequence),
                Hello(sequence, 2),
                Halt(sequence),
                Release(sequence),
            ]
            message = dice.choices(said, [20, 30, 1, 1, 2, 0.3, 0.5, 1.5])[0]
            octets = encode(message)
            if dice.random() < 0.05:
                octets = octets.replace(b",", b";", 1)
        if dice.random() < 0.01:
            board.left_fault = not board.left_fault
            pico.faults = frozenset("L") if board.left_fault else frozenset()
        if dice.random() < 0.02:
            board.battery = dice.choice([7400, 7400, 6100, 5500])
            pico.battery_v = board.battery / 1000
        for octet in octets:
            firmware.feed(octet)
        pico.feed(octets)
        for _ in range(dice.choice([1, 1, 1, 1, 30])):
            board.ms += 10
            firmware.step()
            told = [message for message in decoder.feed(pico.step()) if isinstance(message, Telemetry)]
            real = [message for message in other.feed(board.out) if isinstance(message, Telemetry)]
            board.out = b""
            assert pico.flags | {"N"} == firmware.flags
            assert bool(world.asked.left_rad_s) == board.moves
            assert [(m.seq, m.obeyed, m.steering_rad, m.refused, m.uptime_ms) for m in told] == [
                (m.seq, m.obeyed, m.steering_rad, m.refused, m.uptime_ms) for m in real
            ]


HEIGHT, WIDTH = 96, 128
