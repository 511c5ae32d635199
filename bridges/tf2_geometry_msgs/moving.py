"""What a transform does to a point, a vector and a pose."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

import numpy as np
import numpy.typing as npt
from geometry_msgs.msg import PointStamped, Pose, PoseStamped, Vector3Stamped
from tf2_ros import TransformRegistration

Turn = tuple[float, float, float, float]
Vector = npt.NDArray[np.float64]


def do_transform_point(point: Any, transform: Any) -> Any:
    """Return a PointStamped in the frame of the transform's header."""
    found = PointStamped(header=deepcopy(transform.header))
    moved = _turned(_turn(transform), _vector(point.point)) + _vector(transform.transform.translation)
    found.point.x, found.point.y, found.point.z = moved.tolist()
    return found


def do_transform_vector3(vector3: Any, transform: Any) -> Any:
    """Return a Vector3Stamped, which is turned and not moved."""
    found = Vector3Stamped(header=deepcopy(transform.header))
    moved = _turned(_turn(transform), _vector(vector3.vector))
    found.vector.x, found.vector.y, found.vector.z = moved.tolist()
    return found


def do_transform_pose(pose: Any, transform: Any) -> Any:
    """Return a Pose, turned and moved."""
    turn = _turn(transform)
    place = _turned(turn, _vector(pose.position)) + _vector(transform.transform.translation)
    found = Pose()
    found.position.x, found.position.y, found.position.z = place.tolist()
    inner = pose.orientation
    x, y, z, w = _product(turn, (inner.x, inner.y, inner.z, inner.w))
    found.orientation.x, found.orientation.y, found.orientation.z = x, y, z
    found.orientation.w = w
    return found


def do_transform_pose_stamped(pose: Any, transform: Any) -> Any:
    """Return a PoseStamped in the frame of the transform's header."""
    return PoseStamped(header=deepcopy(transform.header), pose=do_transform_pose(pose.pose, transform))


def _turn(transform: Any) -> Turn:
    turn = transform.transform.rotation
    return turn.x, turn.y, turn.z, turn.w


def _vector(point: Any) -> Vector:
    return np.array([point.x, point.y, point.z])


def _turned(turn: Turn, vector: Vector) -> Vector:
    axis = np.array(turn[:3])
    twice = 2.0 * np.cross(axis, vector)
    return np.asarray(vector + turn[3] * twice + np.cross(axis, twice))


def _product(a: Turn, b: Turn) -> Turn:
    left, right = np.array(a[:3]), np.array(b[:3])
    x, y, z = (a[3] * right + b[3] * left + np.cross(left, right)).tolist()
    return x, y, z, float(a[3] * b[3] - left @ right)


for _kind, _move in (
    (PointStamped, do_transform_point),
    (PoseStamped, do_transform_pose_stamped),
    (Vector3Stamped, do_transform_vector3),
):
    TransformRegistration().add(_kind, _move)
