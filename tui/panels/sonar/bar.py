"""The bar, its scale, the big number and the trend of a sonar, as lines of ink."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from textual.renderables.digits import DIGITS, DIGITS3X3_BOLD

from text.i18n import _, decimal
from tui.panels.sonar.words import RANGE_M, Zone, zone_of
from tui.widgets.drawing import Ink, Line

if TYPE_CHECKING:
    from tui.panels.sonar.words import Bounds

EIGHTHS = " ▏▎▍▌▋▊▉█"
HEIGHTS = " ▁▂▃▄▅▆▇█"
_INK = {Zone.FREE: "good", Zone.CLOSE: "warn", Zone.STOP: "bad", Zone.BLIND: "bad"}


def ink_of(metres: float, bounds: Bounds) -> str:
    """The look of a bar of this length."""
    return _INK[zone_of(metres, bounds)]


def bar(metres: float, width: int, bounds: Bounds) -> Line:
    """A bar from 0 to `RANGE_M`; with a stroke at each bound beyond its end."""
    if width < 1:
        return []
    look = ink_of(metres, bounds)
    if math.isnan(metres):
        return [Ink(("? " * width)[:width], look)]
    if math.isinf(metres) and metres > 0:
        return [Ink("━" * (width - 1) + "▶", look)]
    eighths = round(8 * width * min(max(metres, 0.0), RANGE_M) / RANGE_M)
    full, part = divmod(eighths, 8)
    filled = "█" * full + (EIGHTHS[part] if part else "")
    if metres > RANGE_M:
        filled = "█" * (width - 1) + "▶"
    rest = ["·"] * (width - len(filled))
    for mark in bounds:
        place = mark_cell(mark, width) - len(filled)
        if 0 <= place < len(rest):
            rest[place] = "│"
    return [Ink(filled, look), Ink("".join(rest), "muted")]


def mark_cell(metres: float, width: int) -> int:
    """The cell of the bar for this distance."""
    return min(width - 1, int(width * metres / RANGE_M))


def scale(width: int, bounds: Bounds) -> Line:
    """Numbers below the strokes of the bar."""
    cells = [" "] * width
    for metres, text in (
        (0.0, "0"),
        *((metres, "↑" + decimal(f"{metres:g}")) for metres in bounds),
        (RANGE_M, _("{metres} m").format(metres=decimal(f"{RANGE_M:g}"))),
    ):
        start = min(mark_cell(metres, width), width - len(text))
        place = cells[max(0, start - 1) : start + len(text) + 1]
        if start >= 0 and all(cell == " " for cell in place):
            cells[start : start + len(text)] = text
    return [Ink("".join(cells), "muted")]


def big(text: str, look: str) -> list[Line]:
    """Digits three lines high."""
    rows = ["", "", ""]
    for char in text:
        place = DIGITS.find(char)
        for row in range(3):
            if place >= 0:
                rows[row] += DIGITS3X3_BOLD[3 * place + row].ljust(3)
            else:
                rows[row] += char if row == 2 else " "
    return [[Ink(row, look)] for row in rows]


def trend(values: Iterable[float], width: int, height: int, bounds: Bounds) -> list[Line]:
    """The newest values as columns, the newest on the right; `?` for an invalid reading."""
    shown = list(values)[-width:]
    lines: list[Line] = []
    for row in range(height - 1, -1, -1):
        line: Line = [Ink(" " * (width - len(shown)))]
        line.extend(_column(value, row, height, bounds) for value in shown)
        lines.append(_joined(line))
    return lines


def _column(metres: float, row: int, height: int, bounds: Bounds) -> Ink:
    look = ink_of(metres, bounds)
    if math.isnan(metres):
        return Ink("?" if row == 0 else " ", look)
    share = min(max(metres, 0.0), RANGE_M) / RANGE_M
    eighths = max(1, round(8 * height * share)) - 8 * row
    return Ink(HEIGHTS[min(8, max(0, eighths))], look)


def _joined(line: Line) -> Line:
    joined: Line = []
    for text, look in line:
        if joined and joined[-1].look == look:
            joined[-1] = Ink(joined[-1].text + text, look)
        elif text:
            joined.append(Ink(text, look))
    return joined
