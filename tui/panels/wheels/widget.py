"""The wheels: the chassis from above, and how fast each rear wheel turns."""

from __future__ import annotations

import math

from rich.cells import cell_len

from text.figures import figure, short
from text.i18n import _, decimal
from tui.panels.wheels.chassis import chassis, speed_bar
from tui.panels.wheels.reading import WheelsReading, can_be_turned_to
from tui.widgets.drawing import Drawing, Ink, Line, beside, cells_of, fit

MOST_M_S = 0.5
"""A speed of this many m/s fills the bar; a faster wheel stretches the scale."""
DRAWN_FROM = (30, 8)
"""Columns and lines from which on the chassis is drawn."""
SIDE = 9
"""Cells for `-0.25 m/s`."""


class WheelsView(Drawing):
    """Shows a `WheelsReading`: in words from one line on, drawn from above if there is room."""

    def __init__(self, id: str | None = None, classes: str | None = None) -> None:
        """Start without a reading."""
        super().__init__(id=id, classes=classes)
        self._wheels: WheelsReading | None = None

    def show(self, wheels: WheelsReading) -> None:
        """Show these speeds and this angle."""
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
        if height == 1:
            return [self._one_line(wheels, width)]
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

    def _one_line(self, wheels: WheelsReading, width: int) -> Line:
        speeds = [
            Ink(_("left") + " " + speed_words(wheels.left_m_s), "accent"),
            Ink("  "),
            Ink(_("right") + " " + speed_words(wheels.right_m_s), "second"),
        ]
        words = self.stale_words if self.stale else wheels.words
        word = [Ink(words, "alert" if self.stale else "strong")]
        if cells_of(speeds) + cells_of(word) >= width:
            speeds = [
                Ink(f"{number_words(wheels.left_m_s)} ‖ ", "accent"),
                Ink(speed_words(wheels.right_m_s), "second"),
            ]
        return beside(speeds, word, width)


def _number(value: float) -> float:
    return value if math.isfinite(value) else 0.0


def _side(name: str, speed: float, rows: int, look: str, *, right: bool) -> list[Line]:
    """Name and speed of a wheel, beside the rear wheels."""
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
    """`-0.25`."""
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
    """`R 0.46 m`, without a sign: the angle shows the side."""
    if math.isnan(radius_m):
        return "R ---"
    if math.isinf(radius_m):
        return "R ∞"
    return "R " + _("{metres} m").format(metres=figure(abs(radius_m)))
