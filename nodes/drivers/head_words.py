"""The messages of the head, and the parameters of its servos."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nodes.parts.parameters import Number, Setting, Switch, Text, Whole
from robot.limits import HEAD_ANGLE, Limits
from robot.motion.head import HeadJoint
from robot.wire.lsc16 import BAUD, SERVO
from text.i18n import N_

if TYPE_CHECKING:
    from collections.abc import Mapping

    from nodes.parts.parameters import Value

STARTED = N_("The head is ready for {service}")
STARTED_AT_PORT = N_(
    "The head at {port}: {service}; /head_state is the commanded position, as servos do not report theirs"
)
TURNING = N_("Turning the head to pan {pan}°, tilt {tilt}°")
DONE = N_("The head is there: pan {pan}°, tilt {tilt}°")
WAITING = N_("The head is moving; pan {pan}°, tilt {tilt}° waits for its turn")
OUT_OF_RANGE = N_(
    "Refused: pan {pan}°, tilt {tilt}° — pan must be from {pan_low:g}° to {pan_high:g}°,"
    " tilt from {tilt_low:g}° to {tilt_high:g}°"
)
BUSY = N_("Refused: pan {pan}°, tilt {tilt}° — {count} requests are waiting already")
NO_HEAD = N_("Refused: pan {pan}°, tilt {tilt}° — {reason}")

SAME_SERVO = N_("pan_servo and tilt_servo are both {pan_servo}; each joint has a servo of its own")
_NO_ROOM = {
    "pan": N_("nothing is left between pan_min and pan_max, with pan_trim {pan_trim:g}"),
    "tilt": N_("nothing is left between tilt_min and tilt_max, with tilt_trim {tilt_trim:g}"),
}


DESCRIPTIONS = (
    N_("Channel of the pan servo"),
    N_("Minimum pan"),
    N_("Maximum pan"),
    N_("Angle of the pan servo at which the head looks straight ahead"),
    N_("Whether a longer pulse turns the head right"),
    N_("Channel of the tilt servo"),
    N_("Minimum tilt"),
    N_("Maximum tilt"),
    N_("Angle of the tilt servo at which the head looks straight ahead"),
    N_("Whether a longer pulse turns the head down"),
)
"""Texts made below, marked for the catalogue."""


def _joint_settings(joint: str, servo: int, way: str) -> tuple[Setting, ...]:
    low, high = float(HEAD_ANGLE.low), float(HEAD_ANGLE.high)
    return (
        Whole(
            f"{joint}_servo",
            servo,
            f"Channel of the {joint} servo",
            fixed=True,
            low=int(SERVO.low),
            high=int(SERVO.high),
        ),
        Number(f"{joint}_min", low, f"Minimum {joint}", fixed=True, low=low, high=high, unit="deg"),
        Number(f"{joint}_max", high, f"Maximum {joint}", fixed=True, low=low, high=high, unit="deg"),
        Number(
            f"{joint}_trim",
            0.0,
            f"Angle of the {joint} servo at which the head looks straight ahead",
            low=-45.0,
            high=45.0,
            unit="deg",
        ),
        Switch(f"{joint}_reversed", False, f"Whether a longer pulse turns the head {way}", fixed=True),
    )


SERVO_SETTINGS: tuple[Setting, ...] = (
    Text("port", "", "Port of an LSC-16, as in /dev/serial/by-id; empty: simulated", True, may_be_empty=True),
    Whole("baud", BAUD, "Speed of the port", fixed=True, low=9600, high=921_600),
    Number("speed", 90.0, "Speed of the servos, with a port", low=10.0, high=360.0, unit="deg/s"),
    *_joint_settings("pan", 1, "right"),
    *_joint_settings("tilt", 2, "down"),
    Number(
        "servo_turn",
        180.0,
        "Travel of a servo from its shortest to its longest pulse",
        fixed=True,
        low=90.0,
        high=360.0,
        unit="deg",
    ),
    Number(
        "battery_every_s",
        1.0,
        "How often to ask for the voltage, to check the controller; 0: never",
        fixed=True,
        low=0.0,
        high=60.0,
        unit="s",
    ),
    Number("battery_low", 6.0, "Below this it warns", low=0.0, high=30.0, unit="V"),
)


def joint(values: Mapping[str, Value], name: str) -> HeadJoint:
    """Return the joint that the parameters describe; `name` is pan or tilt."""
    return HeadJoint(
        servo=int(values[f"{name}_servo"]),
        limits=Limits(float(values[f"{name}_min"]), float(values[f"{name}_max"]), "deg"),
        trim_deg=float(values[f"{name}_trim"]),
        reversed=bool(values[f"{name}_reversed"]),
        turn_deg=float(values["servo_turn"]),
    )


def contradiction(values: Mapping[str, Value]) -> str | None:
    """Return what is wrong with this combination of parameters."""
    if values["pan_servo"] == values["tilt_servo"]:
        return SAME_SERVO
    for name, phrase in _NO_ROOM.items():
        reach = joint(values, name).reach
        if reach.low >= reach.high:
            return phrase
    return None
