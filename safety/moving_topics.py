"""The topics that move a robot: published from a recording only on request."""

from __future__ import annotations

from text.robot import robot

STOPPED_BY_ZEROS = frozenset(
    {
        "ackermann_msgs/msg/AckermannDrive",
        "ackermann_msgs/msg/AckermannDriveStamped",
        "geometry_msgs/msg/Twist",
        "geometry_msgs/msg/TwistStamped",
    }
)
"""Command types whose empty message is a stop."""
MOVING_TYPES = STOPPED_BY_ZEROS | {"trajectory_msgs/msg/JointTrajectory", "trajectory_msgs/msg/JointTrajectoryPoint"}


def moves(name: str, type_name: str) -> bool:
    """Return whether a message on this topic may move a robot that receives it."""
    return type_name in MOVING_TYPES or name in robot().moving
