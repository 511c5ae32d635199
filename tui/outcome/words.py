"""The messages that follow a command, and what is wrong with the LLM's JSON, as short sentences."""

from __future__ import annotations

import contextlib
import math
from typing import TYPE_CHECKING, Any

from robot.commands.problems import Problem
from robot.joints import REAR_LEFT_WHEEL, REAR_RIGHT_WHEEL
from robot.kinematics import WHEEL_RADIUS_M
from text.figures import figure, whole
from text.i18n import _, language
from text.nested import read_json
from text.plain import plain

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import Value

LONGEST = 400
LONGEST_PROBLEM = 300


def problem_words(problem: Problem) -> str:
    """The place, the field and the fix: `line 3, column 12: commands[1].speed: must be …`."""
    place = _("line {line}, column {column}").format(line=problem.line, column=problem.column)
    message = problem.message
    if language() == "ru":
        # One that llm_parser reports may be of any make.
        with contextlib.suppress(KeyError, ValueError, IndexError, TypeError):
            message = problem.in_language("ru")
    return plain(": ".join(part for part in (place, problem.field, message) if part), LONGEST_PROBLEM)


def reported_words(report: Mapping[str, Any]) -> str:
    """The same for a problem reported by llm_parser; accepts any report."""
    field, message, code = (str(report.get(name, "")) for name in ("field", "message", "code"))
    args = report.get("args")
    place = report.get("line", 1), report.get("column", 1)
    return problem_words(Problem(field, *place, message, code, args if isinstance(args, dict) else {}))


def setpoint(value: Mapping[str, Value]) -> tuple[float, float]:
    """Speed in m/s and steering in rad of an AckermannDriveStamped, nan where missing."""
    drive = value.get("drive")
    fields: Mapping[str, Any] = drive if isinstance(drive, dict) else {}
    return number(fields.get("speed")), number(fields.get("steering_angle"))


def drive_words(speed_m_s: float, steering_rad: float) -> str:
    """Describe a setpoint, and the side it steers to."""
    words = _("{speed} m/s, {steering} rad, straight on")
    if steering_rad > 0:
        words = _("{speed} m/s, {steering} rad, to the left")
    elif steering_rad < 0:
        words = _("{speed} m/s, {steering} rad, to the right")
    return words.format(speed=figure(speed_m_s), steering=figure(steering_rad))


def wheel_words(value: Mapping[str, Value]) -> str:
    """Describe the speeds of the rear wheels in a JointState."""
    return rim_words(joint(value, REAR_LEFT_WHEEL, "velocity"), joint(value, REAR_RIGHT_WHEEL, "velocity"))


def rim_words(left_rad_s: float, right_rad_s: float) -> str:
    """Describe how fast the wheels roll: in m/s, as the panel of the wheels does."""
    return _("left {left}, right {right} m/s").format(
        left=figure(left_rad_s * WHEEL_RADIUS_M), right=figure(right_rad_s * WHEEL_RADIUS_M)
    )


def head_words(pan_rad: float, tilt_rad: float) -> str:
    """Describe where the head looks."""
    return _("pan {pan}°, tilt {tilt}°").format(pan=whole(math.degrees(pan_rad)), tilt=whole(math.degrees(tilt_rad)))


def service_words(event: Mapping[str, Any]) -> tuple[bool, str]:
    """Whether the head accepted a command, and its answer, from llm_parser's `head` event."""
    asked = head_words(math.radians(number(event.get("pan"))), math.radians(number(event.get("tilt"))))
    error = event.get("error")
    if error:
        return False, plain(f"{asked}: {error}", LONGEST)
    if event.get("sum") == 1:
        return True, _("{head}: done").format(head=asked)
    return False, _("{head}: refused").format(head=asked)


def joint(value: Mapping[str, Value], name: str, field: str = "position") -> float:
    """A value of one joint of a JointState, nan if it has none."""
    names: Any = value.get("name")
    figures: Any = value.get(field)
    try:
        return float(figures[list(names).index(name)])
    except (TypeError, ValueError, IndexError):
        return math.nan


def event_of(value: Mapping[str, Value]) -> dict[str, Any]:
    """The JSON object in a std_msgs/String, empty if there is none."""
    try:
        found = read_json(str(value.get("data")))
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


def number(value: object) -> float:
    """A number from outside, nan if it is not one."""
    try:
        return float(value) if isinstance(value, (int, float)) else math.nan
    except OverflowError:
        # Integers in JSON may be of any length.
        return math.nan
