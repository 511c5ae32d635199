"""Which topics move a robot: what nobody publishes from a recording unless he asks for it."""

from __future__ import annotations

EMERGENCY_STOP = "/emergency_stop"
"""Never out of a recording: its false would release a stop that somebody has given."""
STOPPED_BY_ZEROS = frozenset(
    {
        "ackermann_msgs/msg/AckermannDrive",
        "ackermann_msgs/msg/AckermannDriveStamped",
        "geometry_msgs/msg/Twist",
        "geometry_msgs/msg/TwistStamped",
    }
)
"""Types of commands of which an empty message is a stop."""
MOVING_TYPES = STOPPED_BY_ZEROS | {
    "trajectory_msgs/msg/JointTrajectory",
    "trajectory_msgs/msg/JointTrajectoryPoint",
}
MOVING_NAMES = frozenset(
    {
        "/wheel_commands",
        "/ai_command",
        "/llm_raw_json",
        # The brain obeys a voice.
        "/audio/mic_raw",
        "/goal_pose",
    }
)


def moves(name: str, type_name: str) -> bool:
    """Tell whether a message on this topic may move a robot that hears it."""
    return type_name in MOVING_TYPES or name in MOVING_NAMES
