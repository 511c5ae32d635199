"""Which topics and services an agent may use directly: what the profile lists, and never motion.

Besides what moves the robot, this keeps agents from what the safety gate and the emergency stop
rely on, and from services that change how nodes work.
"""

from __future__ import annotations

from agents.refusal import refused
from robot.safety.moving_topics import moves
from robot.topics import (
    BRAIN_STATE,
    COMMAND_SOURCES,
    DRIVE_SAFE,
    EMERGENCY_STATE,
    EMERGENCY_STOP,
    HEAD_SERVICE,
    MOCK_MOTORS,
    MOCK_POSE,
    ODOMETRY,
    SAFETY_STATE,
    SONAR_FRONT,
    SONAR_REAR,
    TF,
    TF_STATIC,
    VLM_DESCRIPTION,
    VLM_DETECTIONS,
)

KEPT = frozenset(
    {
        *COMMAND_SOURCES,
        BRAIN_STATE,
        DRIVE_SAFE,
        EMERGENCY_STATE,
        EMERGENCY_STOP,
        MOCK_MOTORS,
        MOCK_POSE,
        ODOMETRY,
        SAFETY_STATE,
        SONAR_FRONT,
        SONAR_REAR,
        TF,
        TF_STATIC,
        VLM_DESCRIPTION,
        VLM_DETECTIONS,
    }
)
"""Topics that no profile opens to agents: motion, and what a decision about it rests on."""
KEPT_PACKAGES = frozenset({"rcl_interfaces", "lifecycle_msgs", "composition_interfaces"})
"""Packages of services that change the parameters or the life of a node."""


def full_name(name: str) -> str:
    """Return the name of a topic or service from the root."""
    return f"/{name.lstrip('/')}"


def check_publish(topic: str, type_name: str, listed: tuple[str, ...]) -> None:
    """Raise a RefusedError if an agent may not publish on a topic."""
    if topic not in map(full_name, listed):
        raise refused("the profile does not list {name} below `agents: publish:`", name=topic)
    if topic in KEPT or moves(topic, type_name):
        raise refused("{name} may move the robot, or its safety rests on it: use `propose`", name=topic)


def check_call(service: str, type_name: str, listed: tuple[str, ...]) -> None:
    """Raise a RefusedError if an agent may not call a service."""
    if service not in map(full_name, listed):
        raise refused("the profile does not list {name} below `agents: call:`", name=service)
    if service.rpartition("/")[2] == HEAD_SERVICE:
        raise refused("{name} moves the head: use `head`", name=service)
    if type_name.partition("/")[0] in KEPT_PACKAGES:
        raise refused("{name} changes how a node works: no agent may call it", name=service)
