"""Where the commands of the keys go: to the gate, past it, or nowhere; and why nowhere."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

from robot.topics import DRIVE, DRIVE_SAFE, DRIVE_TELEOP
from text.i18n import _

if TYPE_CHECKING:
    from graph.data import GraphUpdate, Value
    from robot.words import DriveSetpoint

DRIVE_TYPE = "ackermann_msgs/msg/AckermannDriveStamped"
RATE_HZ = 20.0
"""Rate of the commands while a key is held."""
FRAME = "base_link"


class Route(NamedTuple):
    """The topic that the keys publish to."""

    topic: str = ""
    """Empty: nobody listens."""
    gated: bool = False
    """Whether a gate stands between it and the wheels."""


def route(update: GraphUpdate | None) -> Route:
    """Return the topic that has a subscriber, preferring that of the gate."""
    rows = {row.name: row for row in update.topics} if update is not None else {}
    safe = rows.get(DRIVE_SAFE)
    gated = safe is not None and safe.publishers > 0
    for topic in (DRIVE_TELEOP, DRIVE):
        row = rows.get(topic)
        if row is not None and row.subscribers:
            return Route(topic, gated or topic == DRIVE_TELEOP)
    return Route("", gated)


def nowhere_words() -> str:
    """Say that nothing will move, why, and what to do."""
    words = _("Nobody listens to {gate} or {drive}: nothing will move. Start {nodes}.")
    nodes = "safety_stop, electronic_differential"
    return words.format(gate=DRIVE_TELEOP, drive=DRIVE, nodes=nodes)


def command(setpoint: DriveSetpoint) -> Mapping[str, Value]:
    """Return an AckermannDriveStamped as a tree."""
    return {
        "header": {"frame_id": FRAME},
        "drive": {"speed": setpoint.speed_m_s, "steering_angle": setpoint.steering_rad},
    }
