"""A robot in a room, as the Space screen is told of it: map, scan, cloud, path, markers, frames."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from graph.data import FrameRow, GraphUpdate, Sample, TopicRow
from robot.motion.odometry import Pose
from space.buffer import Stamped
from space.transform import Transform
from tests.tui.recorded_lesson import lesson_update, sample, topic
from tests.tui.recorded_map import driven, odometry, reading, room, stamped
from tests.unit.space.trees import cloud_tree, header, marker, pose_tree

STRING = "std_msgs/msg/String"
CLOUD, SCAN = "sensor_msgs/msg/PointCloud2", "sensor_msgs/msg/LaserScan"
PATH, MARKERS = "nav_msgs/msg/Path", "visualization_msgs/msg/MarkerArray"
RANGE, GRID = "sensor_msgs/msg/Range", "nav_msgs/msg/OccupancyGrid"
ODOMETRY, POSE, FLOAT = ("nav_msgs/msg/Odometry", "geometry_msgs/msg/PoseStamped", "std_msgs/msg/Float32")
URDF = """
<robot name="cart">
  <link name="base_link">
    <visual>
      <origin xyz="0.12 0 0.12"/><geometry><box size="0.5 0.36 0.12"/></geometry>
      <material name="blue"><color rgba="0.3 0.5 1 1"/></material>
    </visual>
    <visual>
      <origin xyz="-0.05 0.2 0.1" rpy="1.5708 0 0"/>
      <geometry><cylinder radius="0.1" length="0.06"/></geometry>
    </visual>
    <visual>
      <origin xyz="-0.05 -0.2 0.1" rpy="1.5708 0 0"/>
      <geometry><cylinder radius="0.1" length="0.06"/></geometry>
    </visual>
  </link>
  <link name="camera_link">
    <visual><geometry><sphere radius="0.06"/></geometry></visual>
  </link>
  <joint name="mast" type="fixed"><parent link="base_link"/><child link="camera_link"/></joint>
</robot>
"""
SPACE_TOPICS: tuple[TopicRow, ...] = (
    topic("/cliff", RANGE, 10.0, 40),
    topic("/depth/points", CLOUD, 10.0, 4_800_000),
    topic("/goal_pose", POSE, None, age_s=7.0, count=1),
    topic("/map", GRID, None, age_s=80.0, count=1),
    topic("/markers", MARKERS, 1.0, 900),
    topic("/odom", ODOMETRY, 50.0, 720),
    topic("/plan", PATH, 1.0, 2000),
    topic("/robot_description", STRING, None, age_s=80.0, count=1),
    topic("/scan", SCAN, 10.0, 1500),
    topic("/sensor/sonar_front", FLOAT, 100.0, 8),
    topic("/sensor/sonar_rear", FLOAT, 100.0, 8),
)


def flat(pose: Pose, z_m: float = 0.0) -> Transform:
    return Transform.from_rpy((pose.x_m, pose.y_m, z_m), (0.0, 0.0, pose.heading_rad))


def frame_row(parent: str, child: str, at: Transform, *, static: bool = True) -> FrameRow:
    return FrameRow(Stamped(parent, child, 10.0, at, static), 1, None if static else 20.0)


def scan(turned: float = 0.0, rays: int = 240) -> Sample:
    world, _path = driven()
    at = flat(world.pose) @ Transform((0.15, 0.0, 0.2))
    angles = np.linspace(-math.pi, math.pi, rays, endpoint=False)
    ranges = [
        world.room.distance(at.translation[0], at.translation[1], world.pose.heading_rad + angle) for angle in angles
    ]
    value = {
        "header": header("laser"),
        "angle_min": -math.pi + turned,
        "angle_increment": 2 * math.pi / rays,
        "range_min": 0.05,
        "range_max": 12.0,
        "ranges": np.array(ranges, dtype=np.float32),
    }
    return sample("/scan", SCAN, value)


@lru_cache
def boxes() -> np.ndarray[Any, Any]:
    """Points of a box and a ball in front of the camera, seen in its frame (x ahead)."""
    rng = np.random.default_rng(3)
    faces = rng.uniform(-0.25, 0.25, (6000, 3))
    faces[np.arange(6000), rng.integers(0, 3, 6000)] = rng.choice([-0.25, 0.25], 6000)
    ball = rng.normal(size=(4000, 3))
    ball *= 0.3 / np.linalg.norm(ball, axis=1)[:, None]
    return np.concatenate([faces + np.array([1.2, 0.5, 0.0]), ball + np.array([1.5, -0.5, 0.05])])


def path(frame: str = "map") -> Sample:
    world, _path = driven()
    goal = Pose(3.2, 1.4)
    steps = [
        Pose(
            world.pose.x_m + (goal.x_m - world.pose.x_m) * share,
            world.pose.y_m + (goal.y_m - world.pose.y_m) * share + 0.3 * math.sin(share * math.pi),
        )
        for share in np.linspace(0, 1, 20).tolist()
    ]
    poses = [{"header": header(frame), "pose": pose_tree(flat(pose))} for pose in steps]
    return sample("/plan", PATH, {"header": header(frame), "poses": poses})


def frames() -> tuple[FrameRow, ...]:
    """The frames of the robot where it has driven to."""
    world, _path = driven()
    return (
        frame_row("odom", "base_link", flat(world.pose), static=False),
        frame_row("base_link", "camera_link", Transform((0.2, 0.0, 0.3))),
        frame_row("base_link", "laser", Transform((0.15, 0.0, 0.2))),
        frame_row("map", "odom", Transform(), static=False),
    )


def floor() -> Sample:
    """The room of the simulated robot, with a stamp."""
    found = room("map")
    return replace(found, value={**found.value, "header": header("map")})


def marker_sample(**more: Any) -> Sample:
    """A charger: a box with its name over it."""
    markers = [
        marker(1, 1, Transform((3.6, 0.4, 0.3)), (0.4, 0.4, 0.6), **more),
        marker(2, 9, Transform((3.6, 0.4, 0.9)), (0.1, 0.1, 0.1), text="charger", **more),
    ]
    return sample("/markers", MARKERS, {"markers": markers})


def space_update(
    rows: Mapping[str, Mapping[str, Any]] | None = None,
    frame_rows: tuple[FrameRow, ...] | None = None,
    **samples: tuple[Sample, ...],
) -> GraphUpdate:
    """The graph with all of it; by topic, without slashes, what it says instead."""
    _world, way = driven()
    cliff = {"header": header("base_link"), "field_of_view": 0.4, "range": 0.8, "max_range": 2.0}
    said = {
        "cliff": (sample("/cliff", RANGE, cliff),),
        "depth_points": (sample("/depth/points", CLOUD, cloud_tree(boxes(), "camera_link")),),
        "goal_pose": (stamped("/goal_pose", Pose(3.2, 1.4), "map"),),
        "map": (floor(),),
        "markers": (marker_sample(),),
        "odom": tuple(odometry(pose, at / 10) for at, pose in enumerate(way)),
        "plan": (path(),),
        "robot_description": (sample("/robot_description", STRING, {"data": URDF}),),
        "scan": (scan(),),
        "sensor_sonar_front": (reading("front", 1.1),),
        "sensor_sonar_rear": (reading("rear", math.inf),),
        **samples,
    }
    changed = rows or {}
    update = lesson_update(
        topics=tuple(replace(row, **changed.get(row.name, {})) for row in SPACE_TOPICS),
        samples={group[0].topic: group for group in said.values() if group},
    )
    return replace(update, frames=frames() if frame_rows is None else frame_rows)
