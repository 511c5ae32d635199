"""The simulated room and robot: rays, motion, collisions, and minutes through the gate."""

from __future__ import annotations

import math
import random
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.motion.odometry import Pose
from robot.safety.distance import SafetyZone
from robot.world.room import LIVING_ROOM, Box, Room
from robot.world.world import Body, SimulatedSonar, Wheels, World
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


@given(small, small, angles, st.floats(0.05, 3), st.floats(0.05, 3))
def test_what_is_far_from_the_walls_does_not_touch_them(
    x: float, y: float, heading: float, length: float, width: float
) -> None:
    box = Box(x, y, length, width, heading)
    if EMPTY.clearance(x, y) > math.hypot(length, width) / 2 + 1e-6:
        assert not EMPTY.touches(box)
    outside = any(max(map(abs, corner)) > 5 + 1e-6 for corner in box.corners())
    if outside:
        assert EMPTY.touches(box)


def test_a_box_inside_of_the_robot_touches_it() -> None:
    assert Room(Box(0, 0, 10, 10), [Box(0, 0, 0.1, 0.1)]).touches(Box(0, 0, 1, 1))


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
    a, b, c = (
        math.dist((bx, by), (cx, cy)),
        math.dist((ax, ay), (cx, cy)),
        math.dist((ax, ay), (bx, by)),
    )
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


def test_a_stalled_motor_does_not_turn() -> None:
    world = World(EMPTY, stalled=(True, False))
    drive(world, 0.3)
    let_pass(world, 1.0)
    assert world.wheels.left_rad_s == 0
    assert world.wheels.right_rad_s > 5


@given(orders, st.integers(0, 5))
def test_the_same_orders_give_the_same_drive(
    sent: list[tuple[float, float, float]], seed: int
) -> None:
    results = []
    for _again in range(2):
        world = World(seed=seed)
        for left, right, steering in sent:
            world.asked = Wheels(left, right, steering)
            let_pass(world, 0.21)
        results.append((world.pose, world.steps, world.collisions, repr(world.read_sonars())))
    assert results[0] == results[1]


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


def test_noise_and_dropouts_are_as_many_as_asked_for() -> None:
    dice, sonar = random.Random(2), SimulatedSonar(noise_m=0.02, dropout=0.1)
    read = [sonar.read(EMPTY, Body(), Pose(2, 0), dice) for _ in range(2000)]
    good = [metres for metres in read if not math.isnan(metres)]
    assert len(good) == pytest.approx(1800, abs=60)
    mean = sum(good) / len(good)
    assert mean == pytest.approx(2.7, abs=0.003)
    assert math.sqrt(sum((metres - mean) ** 2 for metres in good) / len(good)) == pytest.approx(
        0.02, abs=0.002
    )


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
