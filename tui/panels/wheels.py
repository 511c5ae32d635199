"""The Wheels panel: how fast the wheels turn, or would, and how they are steered, from above."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rich.cells import cell_len

from graph.data import GraphUpdate
from robot.joints import REAR_LEFT_WHEEL, REAR_RIGHT_WHEEL, STEERING
from robot.kinematics import TRACK_M, WHEEL_RADIUS_M, WHEELBASE_M, turning_radius, wheel_speeds
from robot.topics import DRIVE, WHEEL_COMMANDS
from text.figures import figure, short
from text.i18n import N_, _, decimal
from tui.panels.panel import Joints, Panel, first_published, has_joints, joint_number, newest, other_type, trouble_of
from tui.widgets.canvas import Canvas, rectangle
from tui.widgets.drawing import Drawing, Ink, Line, Placeholder, beside, cells_of, fit

STANDING_BELOW_M_S = 0.005
EVEN_WITHIN_M_S = 0.003
FARTHEST_RAD = math.pi
"""Larger angles are invalid: an angle cannot express more than half a turn."""


@dataclass(frozen=True)
class WheelsReading:
    """Speeds of the rear wheels at the rim, and the angle of the front wheels, + is left."""

    left_m_s: float
    right_m_s: float
    steering_rad: float

    @property
    def radius_m(self) -> float:
        """Turning radius, positive to the left, inf when straight, nan if there is no circle."""
        try:
            return turning_radius(self.steering_rad)
        except ValueError:
            return math.nan

    @property
    def words(self) -> str:
        left, right = abs(self.left_m_s), abs(self.right_m_s)
        if not (math.isfinite(left) and math.isfinite(right)):
            return _("not a number")
        if max(left, right) < STANDING_BELOW_M_S:
            return _("standing")
        back = self.left_m_s + self.right_m_s < 0
        if abs(left - right) < EVEN_WITHIN_M_S:
            return _("straight back") if back else _("straight")
        if left < right:
            return _("left wheel slower")
        return _("right wheel slower")


def can_be_turned_to(steering_rad: float) -> bool:
    """Whether this can be the angle of a wheel: finite, and at most half a turn."""
    return abs(steering_rad) <= FARTHEST_RAD


def wheels_in(value: Mapping[str, Any], wheel_radius_m: float = WHEEL_RADIUS_M) -> WheelsReading | None:
    """Read a sensor_msgs/JointState; None if it is not about these wheels.

    A missing joint is read as nan.
    """
    if not has_joints(value, (REAR_LEFT_WHEEL, REAR_RIGHT_WHEEL)):
        return None
    left, right = (joint_number(value, "velocity", wheel) for wheel in (REAR_LEFT_WHEEL, REAR_RIGHT_WHEEL))
    return WheelsReading(left * wheel_radius_m, right * wheel_radius_m, joint_number(value, "position", STEERING))


WHEEL_M = (0.035, 0.085)
"""Width and length of a wheel as drawn: slightly larger than life."""
BODY_M = 0.085
LENGTH_M = WHEELBASE_M + WHEEL_M[1] + 0.02
WIDTH_M = TRACK_M + WHEEL_M[1]
HALF = "▄", "▀"


def chassis(wheels: WheelsReading, columns: int, rows: int) -> list[Line]:
    dots = Canvas(columns, rows)
    scale = min(dots.height / LENGTH_M, dots.width / WIDTH_M)
    middle, front = dots.width / 2, (dots.height - scale * WHEELBASE_M) / 2
    rear = front + scale * WHEELBASE_M
    half_track, half_body = scale * TRACK_M / 2, scale * BODY_M / 2
    for axle in (front, rear):
        dots.line((middle - half_track, axle), (middle + half_track, axle), "muted")
    nose = front - scale * 0.03
    body = [(middle - half_body, front), (middle, nose), (middle + half_body, front)]
    tail = rear + scale * 0.02
    dots.outline([*body, (middle + half_body, tail), (middle - half_body, tail)], "muted")
    angle = wheels.steering_rad if can_be_turned_to(wheels.steering_rad) else 0.0
    size = scale * WHEEL_M[0], scale * WHEEL_M[1]
    for side, look in ((-1, "accent"), (1, "second")):
        x = middle + side * half_track
        dots.fill(rectangle((x, front), *size, angle), "strong")
        dots.fill(rectangle((x, rear), *size, 0.0), look)
    return dots.lines()


def speed_bar(speed_m_s: float, most_m_s: float, rows: int, look: str) -> list[Line]:
    """A bar two cells wide: from the bottom upwards when forward, else from the top downwards."""
    if not math.isfinite(speed_m_s):
        return [[Ink("??" if row == rows // 2 else "  ", "bad")] for row in range(rows)]
    halves = round(2 * rows * min(1.0, abs(speed_m_s) / most_m_s))
    lines: list[Line] = []
    for row in range(rows):
        depth = rows - 1 - row if speed_m_s >= 0 else row
        filled = halves - 2 * depth
        if filled <= 0:
            text = "  " if depth else "──"
        elif filled == 1:
            text = 2 * HALF[speed_m_s < 0]
        else:
            text = "██"
        if 0 < filled <= 2:
            text = "▲▲" if speed_m_s > 0 else "▼▼"
        lines.append([Ink(text, look if filled > 0 else "muted")])
    return lines


MOST_M_S = 0.5
"""A speed of this many m/s fills the bar; a faster wheel stretches the scale."""
DRAWN_FROM = (30, 8)
SIDE = 9


class WheelsView(Drawing):
    """Shows a `WheelsReading`: in words, drawn from above if there is room."""

    def __init__(self) -> None:
        super().__init__()
        self._wheels: WheelsReading | None = None

    def show(self, wheels: WheelsReading) -> None:
        if wheels != self._wheels:
            self._wheels = wheels
            self.redraw()

    @property
    def has_value(self) -> bool:
        return self._wheels is not None

    def draw(self, width: int, height: int) -> list[Line]:
        wheels = self._wheels
        if wheels is None:
            return []
        if width >= DRAWN_FROM[0] and height >= DRAWN_FROM[1]:
            return self._from_above(wheels, width, height)
        return self._rows(wheels, width)[:height]

    def _from_above(self, wheels: WheelsReading, width: int, height: int) -> list[Line]:
        rows = height - 2
        columns = width - 2 * (SIDE + 4)
        picture = chassis(wheels, columns, rows)
        most = max(MOST_M_S, abs(_number(wheels.left_m_s)), abs(_number(wheels.right_m_s)))
        left = speed_bar(wheels.left_m_s, most, rows, "accent")
        right = speed_bar(wheels.right_m_s, most, rows, "second")
        sides = _side(_("left"), wheels.left_m_s, rows, "accent", right=True)
        others = _side(_("right"), wheels.right_m_s, rows, "second", right=False)
        gap = Ink(" ")
        lines = [
            [*sides[row], gap, *left[row], gap, *picture[row], gap, *right[row], gap, *others[row]]
            for row in range(rows)
        ]
        return [self._steering(wheels, width), *lines, self._word_line(wheels, width)]

    def _steering(self, wheels: WheelsReading, width: int) -> Line:
        radius = [Ink(radius_words(wheels.radius_m), "muted")]
        words = angle_words(wheels.steering_rad)
        angle = [Ink(_("steering") + " ", "muted"), Ink(words, "strong")]
        if cells_of(angle) + cells_of(radius) < width:
            return beside(angle, radius, width)
        return beside(angle[1:], radius, width)

    def _word_line(self, wheels: WheelsReading, width: int) -> Line:
        word = [Ink(wheels.words, "strong")]
        return beside(word, [Ink(self.stale_words, "alert")] if self.stale else [], width)

    def _rows(self, wheels: WheelsReading, width: int) -> list[Line]:
        names = [_("left"), _("right")]
        room = max(map(cell_len, names))
        lines = [self._word_line(wheels, width)]
        for name, speed, look in zip(names, (wheels.left_m_s, wheels.right_m_s), ("accent", "second"), strict=True):
            head = f"{fit(name, room)} {speed_words(speed)} "
            lines.append([Ink(head, look), *_level(speed, width - cell_len(head), look)])
        return [*lines, self._steering(wheels, width)]


def _number(value: float) -> float:
    return value if math.isfinite(value) else 0.0


def _side(name: str, speed: float, rows: int, look: str, *, right: bool) -> list[Line]:
    texts = [""] * rows
    words = speed_words(speed)
    texts[rows - 2] = name
    texts[rows - 1] = words if cell_len(words) <= SIDE else number_words(speed)
    return [[Ink(fit(" " * max(0, SIDE - cell_len(text)) + text if right else text, SIDE), look)] for text in texts]


def _level(speed: float, width: int, look: str) -> Line:
    """A bar of full and half cells, with a sign for the direction at its end."""
    cells = round(max(0, width - 1) * min(1.0, abs(_number(speed)) / MOST_M_S))
    sign = "" if not cells else ("▶" if speed > 0 else "◀")
    return [Ink("━" * cells + sign, look)]


def number_words(value: float) -> str:
    return figure(value) if math.isfinite(value) else "---"


def speed_words(speed: float) -> str:
    """`-0.25 m/s`."""
    return _("{speed} m/s").format(speed=number_words(speed))


def angle_words(steering_rad: float) -> str:
    """`0.50 rad 29° left`, or that no wheel can turn that far."""
    if not math.isfinite(steering_rad):
        return "---"
    if not can_be_turned_to(steering_rad):
        return _("out of range: {angle} rad").format(angle=short(steering_rad))
    degrees = round(math.degrees(steering_rad))
    words = _("{degrees}° left") if degrees > 0 else _("{degrees}° right")
    turned = words.format(degrees=abs(degrees)) if degrees else "0°"
    return _("{angle} rad").format(angle=decimal(f"{steering_rad:.2f}")) + f" {turned}"


def radius_words(radius_m: float) -> str:
    if math.isnan(radius_m):
        return "R ---"
    if math.isinf(radius_m):
        return "R ∞"
    return "R " + _("{metres} m").format(metres=figure(abs(radius_m)))


DRIVE_TYPE = "ackermann_msgs/msg/AckermannDriveStamped"


class WheelsPanel(Panel):
    """The rear wheels and the steering, from above."""

    view = WheelsView
    title = N_("Wheels")
    least = 4
    weight = 4
    across_below = 80

    def useful(self, rows: int) -> int:
        """Words take four; from above, a chassis that is higher than this says no more."""
        return min(rows, DRAWN_FROM[1] + 4) if rows >= DRAWN_FROM[1] else min(rows, self.least)

    def __init__(self) -> None:
        super().__init__()
        self._joints = Joints(WHEEL_COMMANDS, (REAR_LEFT_WHEEL, REAR_RIGHT_WHEEL))
        self._placeholder: Placeholder | None = None
        """Shown instead of the drive commands."""

    def watched(self) -> set[str]:
        return {WHEEL_COMMANDS, DRIVE}

    def show(self, update: GraphUpdate) -> None:
        topic = first_published(update, (WHEEL_COMMANDS, DRIVE))
        self.name_source("" if topic == WHEEL_COMMANDS else topic)
        drawing = self.query_one(WheelsView)
        sample = newest(update, topic)
        if sample is not None:
            wheels = wheels_in(sample.value) if topic == WHEEL_COMMANDS else would_be(sample.value)
            if wheels is not None:
                drawing.show(wheels)
            if topic == WHEEL_COMMANDS:
                self._joints.hear(sample, read=wheels is not None)
            else:
                self._placeholder = other_type(sample, DRIVE_TYPE)
        drawing.show_placeholder(self._joints.placeholder if topic == WHEEL_COMMANDS else self._placeholder)
        drawing.show_trouble(*trouble_of(update, topic))


def would_be(value: Mapping[str, Any]) -> WheelsReading | None:
    """Return what an AckermannDriveStamped would make the wheels do; None for an invalid one."""
    drive = value.get("drive")
    if not drive:
        return None
    speed, steering = float(drive["speed"]), float(drive["steering_angle"])
    try:
        speeds = wheel_speeds(speed, steering)
    except ValueError:
        return None
    return WheelsReading(speeds.left_m_s, speeds.right_m_s, steering)
