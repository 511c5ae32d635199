"""The simulated robot on its way to a point, as the map panel is told of it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

from graph.data import GraphUpdate, Sample, TopicRow, Trouble
from robot.kinematics import wheel_speeds
from robot.motion.odometry import Pose
from robot.world.grid import grid_of
from robot.world.world import SimulatedSonar, Wheels, World
from tests.tui.recorded_lesson import NOW_S, SESSION, lesson_update, sample, topic
from tests.unit.random_driver import let_pass

GRID, POSE = "nav_msgs/msg/OccupancyGrid", "geometry_msgs/msg/PoseStamped"
ODOMETRY, FLOAT = "nav_msgs/msg/Odometry", "std_msgs/msg/Float32"
MAP_SESSION = replace(SESSION, name="robot", lesson="", title={"en": "Robot", "ru": "Робот"}, panels=("sonar", "map"))
MAP_TOPICS: tuple[TopicRow, ...] = (
    topic("/goal_pose", POSE, None, age_s=7.0, count=1),
    topic("/map", GRID, None, age_s=80.0, count=1),
    topic("/mock/pose", POSE, 20.0, 80),
    topic("/odom", ODOMETRY, 50.0, 720),
    topic("/sensor/sonar_front", FLOAT, 100.0, 8),
    topic("/sensor/sonar_rear", FLOAT, 100.0, 8),
)


def pose_value(pose: Pose, frame: str = "odom") -> dict[str, Any]:
    """A pose as the messages have it, without what differs between them."""
    half = pose.heading_rad / 2
    return {
        "header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": frame},
        "pose": {
            "position": {"x": pose.x_m, "y": pose.y_m, "z": 0.0},
            "orientation": {"x": 0.0, "y": 0.0, "z": math.sin(half), "w": math.cos(half)},
        },
    }


def odometry(pose: Pose, at_s: float = 0.0, frame: str = "odom") -> Sample:
    """One of /odom, received so many seconds into the recording."""
    value = pose_value(pose, frame)
    value["pose"] = {"pose": value["pose"]}
    return replace(sample("/odom", ODOMETRY, value), received_s=NOW_S + at_s)


def stamped(name: str, pose: Pose, frame: str = "odom") -> Sample:
    return sample(name, POSE, pose_value(pose, frame))


def reading(place: str, metres: float) -> Sample:
    return sample(f"/sensor/sonar_{place}", FLOAT, {"data": metres}, 8)


@lru_cache
def room(frame: str = "odom") -> Sample:
    grid = grid_of(World().room)
    origin = pose_value(Pose(grid.x_m, grid.y_m))["pose"]
    rows, columns = grid.cells.shape
    info = {"resolution": grid.cell_m, "width": columns, "height": rows, "origin": origin}
    value = {"header": {"frame_id": frame}, "info": info, "data": grid.cells.ravel()}
    return sample("/map", GRID, value, grid.cells.size)


@lru_cache
def driven() -> tuple[World, tuple[Pose, ...]]:
    """The robot after some curves, and where it was on the way, ten times a second."""
    world, path = (World(front=SimulatedSonar(noise_m=0.0), rear=SimulatedSonar(forward=False, noise_m=0.0)), [])
    radius = world.body.wheel_radius_m
    for seconds, steering in ((2.0, 0.0), (3.0, 0.5), (3.0, -0.5), (1.2, -0.2)):
        speeds = wheel_speeds(0.3, steering)
        world.asked = Wheels(speeds.left_m_s / radius, speeds.right_m_s / radius, steering)
        for _tenth in range(round(10 * seconds)):
            let_pass(world, 0.1)
            path.append(world.pose)
    return world, tuple(path)


def map_update(rows: Mapping[str, Mapping[str, Any]] | None = None, **samples: tuple[Sample, ...]) -> GraphUpdate:
    """The graph with a robot on its way; by topic, without slashes, what it says instead."""
    world, path = driven()
    ahead, behind = (sonar.true_m(world.room, world.body, world.pose) for sonar in (world.front, world.rear))
    # Odometry is what the wheels believe: a little less of a turn each time.
    believed = [Pose(p.x_m * 1.03, p.y_m * 0.96, p.heading_rad - 0.05) for p in path]
    said = {
        "map": (room(),),
        "odom": tuple(odometry(pose, at / 10) for at, pose in enumerate(believed)),
        "mock_pose": (stamped("/mock/pose", path[-1]),),
        "goal_pose": (stamped("/goal_pose", Pose(3.2, 1.4)),),
        "sonar_front": (reading("front", ahead),),
        "sonar_rear": (reading("rear", behind),),
        **samples,
    }
    changed = rows or {}
    return lesson_update(
        topics=tuple(replace(row, **changed.get(row.name, {})) for row in MAP_TOPICS),
        samples={group[0].topic: group for group in said.values() if group},
    )


NOBODY: dict[str, Any] = {"publishers": 0, "trouble": Trouble.NO_PUBLISHER, "age_s": None}
"""What a row says of a topic that nobody publishes."""
