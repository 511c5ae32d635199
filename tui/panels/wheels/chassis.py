"""The chassis from above, its front at the top, with the wheels at their current angle."""

from __future__ import annotations

import math

from robot.kinematics import TRACK_M, WHEELBASE_M
from tui.panels.dots import Dots, rectangle
from tui.panels.wheels.reading import WheelsReading, can_be_turned_to
from tui.widgets.drawing import Ink, Line

WHEEL_M = (0.035, 0.085)
"""Width and length of a wheel as drawn: slightly larger than life."""
BODY_M = 0.085
LENGTH_M = WHEELBASE_M + WHEEL_M[1] + 0.02
WIDTH_M = TRACK_M + WHEEL_M[1]
HALF = "▄", "▀"


def chassis(wheels: WheelsReading, columns: int, rows: int) -> list[Line]:
    """Draw body, axles and four wheels in this many cells."""
    dots = Dots(columns, rows)
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
