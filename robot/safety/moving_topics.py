"""The topics that move a robot: published from a recording only on request."""

from __future__ import annotations

from robot.topics import AI_COMMAND, DRIVE_SAFE, GOAL_POSE, HEARD, LLM_RAW_JSON, MICROPHONE, WHEEL_COMMANDS

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
MOVING_NAMES = frozenset(
    {
        WHEEL_COMMANDS,
        AI_COMMAND,
        LLM_RAW_JSON,
        # The brain obeys a voice, and what was recognised of it.
        MICROPHONE,
        HEARD,
        GOAL_POSE,
    }
)
SOLE = frozenset({DRIVE_SAFE, WHEEL_COMMANDS})
"""What the wheels obey: only the gate and the differential may publish these."""


def moves(name: str, type_name: str) -> bool:
    """Return whether a message on this topic may move a robot that receives it."""
    return type_name in MOVING_TYPES or name in MOVING_NAMES
