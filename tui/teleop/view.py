"""The display for driving with keys: what is asked, what is allowed, what the wheels do."""

from __future__ import annotations

import math
from typing import NamedTuple

from rich.cells import cell_len

from robot.words import STOP, DriveSetpoint
from text.i18n import _, decimal
from tui.panels.sonar import big
from tui.panels.wheels import WheelsReading, number_words
from tui.teleop.keys import TeleopLimits
from tui.widgets.drawing import Ink, Line, beside, cells_of, fit

BIG_ROWS = 7
"""Lines from which on the numbers are drawn large."""
GAP = 2
STANDING_M_S = 0.005
STRAIGHT_RAD = 0.005


class Driving(NamedTuple):
    """Everything that is shown."""

    asked: DriveSetpoint = STOP
    allowed: DriveSetpoint | None = None
    """What the gate lets through; None without a gate, or before its first report."""
    gated: bool = False
    wheels: WheelsReading | None = None
    limits: TeleopLimits = TeleopLimits()
    words: str = ""
    """The current remark: why nothing moves, or where the commands go."""
    look: str = ""
    """How the words look."""
    allowed_ago: str = ""
    """How old it is, if it is not current any more; likewise of the wheels."""
    wheels_ago: str = ""


def drawn(driving: Driving, width: int, height: int) -> list[Line]:
    """Return the lines, as many as fit."""
    allowed, wheels = driving.allowed, driving.wheels
    midway = None if wheels is None else DriveSetpoint((wheels.left_m_s + wheels.right_m_s) / 2, wheels.steering_rad)
    missing = _("no data yet")
    columns = (
        _column(_("asked"), driving.asked, "accent"),
        _column(
            *(_("allowed"), allowed, _allowed_look(driving)),
            missing=missing if driving.gated else _("no gate"),
            ago=driving.allowed_ago,
        ),
        _column(_("wheels"), midway, "second", _sides(wheels), missing=missing, ago=driving.wheels_ago),
    )
    words: Line = [Ink(fit(driving.words, width), driving.look)]
    limits = _limits(driving.limits, width)
    if height < BIG_ROWS:
        small: Line = []
        for column in columns:
            small += [Ink(column.title + " ", "muted"), Ink(column.speed + "  ", column.look)]
        return [beside(small, [Ink(columns[0].short, "strong")], width), words, limits][:height]
    room = (width - 2 * GAP) // 3
    gap = Ink(" " * GAP)
    lines = [[ink for column in columns for ink in (*column.line(row, room), gap)][:-1] for row in range(5)]
    return [*lines, words, limits]


class _Column(NamedTuple):
    """One of the three numbers."""

    title: str
    speed: str
    detail: str
    look: str
    short: str

    def line(self, row: int, room: int) -> Line:
        """One of its five lines: the title, three for the number, the detail."""
        if row == 0:
            return [Ink(fit(self.title, room), "muted")]
        if row == 4:
            # If there is no room for words, there are arrows.
            detail = self.detail if cell_len(self.detail) <= room else self.short
            return [Ink(fit(detail, room), "strong")]
        unit = _("{speed} m/s").format(speed="").strip() if row == 3 else ""
        number = [*big(self.speed, self.look)[row - 1], Ink(" ")]
        return [*number, Ink(fit(unit, max(0, room - cells_of(number))), "muted")]


def _column(
    title: str, setpoint: DriveSetpoint | None, look: str, detail: str = "", *, missing: str = "", ago: str = ""
) -> _Column:
    """Return a number; `missing` says why there is none, `ago` how old it is if it is not current any more."""
    if ago or setpoint is None:
        return _Column(title, "---", ago or missing, "muted", ago)
    return _Column(title, number_words(setpoint.speed_m_s), detail or _way(setpoint), look, _arrows(setpoint))


def _allowed_look(driving: Driving) -> str:
    allowed, asked = driving.allowed, driving.asked
    if allowed is None or abs(allowed.speed_m_s) >= abs(asked.speed_m_s) - STANDING_M_S:
        return "good"
    return "bad" if abs(allowed.speed_m_s) < STANDING_M_S else "warn"


def _way(setpoint: DriveSetpoint) -> str:
    """`↑ forward  ← 0.30 rad`."""
    speed, angle = setpoint.speed_m_s, setpoint.steering_rad
    if not (math.isfinite(speed) and math.isfinite(angle)):
        return _("not a number")
    way = "■ " + _("standing")
    if abs(speed) >= STANDING_M_S:
        way = "↑ " + _("forward") if speed > 0 else "↓ " + _("back")
    return f"{way}  {_angle(angle)}".rstrip()


def _arrows(setpoint: DriveSetpoint) -> str:
    speed, angle = setpoint.speed_m_s, setpoint.steering_rad
    way = "■" if not abs(speed) >= STANDING_M_S else "↑" if speed > 0 else "↓"
    side = "" if not abs(angle) >= STRAIGHT_RAD else f" {'←' if angle > 0 else '→'} " + decimal(f"{abs(angle):.2f}")
    return way + side


def _angle(angle: float) -> str:
    if not math.isfinite(angle) or abs(angle) < STRAIGHT_RAD:
        return ""
    return ("← " if angle > 0 else "→ ") + _("{angle} rad").format(angle=decimal(f"{abs(angle):.2f}"))


def _sides(wheels: WheelsReading | None) -> str:
    """`0.18 ‖ 0.22  ← 0.30 rad`: each rear wheel, and the steering."""
    if wheels is None:
        return ""
    speeds = f"{number_words(wheels.left_m_s)} ‖ {number_words(wheels.right_m_s)}"
    return f"{speeds}  {_angle(wheels.steering_rad)}".rstrip()


def _limits(limits: TeleopLimits, width: int) -> Line:
    speed = _("{speed} m/s").format(speed=decimal(f"{limits.speed_m_s:.2f}"))
    angle = _("{angle} rad").format(angle=decimal(f"{limits.steering_rad:.2f}"))
    left: Line = [
        Ink(_("speed") + " ", "muted"),
        Ink(speed + " ", "strong"),
        Ink("- +   ", "muted"),
        Ink(_("steering") + " ", "muted"),
        Ink(angle + " ", "strong"),
        Ink("[ ]", "muted"),
    ]
    right: Line = [Ink(_("hold ↑↓←→ or WASD; let go: stop"), "muted")]
    return beside(left, right, width) if cells_of(left) + cells_of(right) < width else left
