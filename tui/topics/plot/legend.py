"""The legend of a plot: field, newest number, and the lowest and highest in the window."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rich.cells import cell_len

from text.i18n import _
from text.plain import plain
from tui.widgets.drawing import Ink, Line, fit
from tui.widgets.figures import UNKNOWN

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tui.topics.plot.field import Series

FIGURE = 9
LEAST_NAME = 18
FIGURES = 5
"""Significant digits."""
HUGE, TINY = 1e6, 1e-4


def legend_lines(series: Sequence[Series], end_s: float, window_s: float, width: int, title: str) -> list[Line]:
    """A title and a line for each field, in columns; without the range if there is little room."""
    titles = (_("last"), _("min"), _("max"))
    shown = 3 if width >= 2 + LEAST_NAME + 3 * (FIGURE + 1) else 1
    longest = max((cell_len(_name(one)) for one in series), default=0)
    room = min(max(LEAST_NAME, longest), max(1, width - 2 - shown * (FIGURE + 1)))
    heads = "".join(" " + title.rjust(FIGURE) for title in titles[:shown])
    lines: list[Line] = [[Ink(fit(title, 2 + room), "strong"), Ink(heads, "muted")]]
    for one in series:
        range_ = one.history.range(end_s, window_s) or (None, None)
        texts = [number_text(number) for number in (one.history.last, *range_)]
        cells = "".join(" " + text.rjust(FIGURE) for text in texts[:shown])
        if not one.is_number:
            cells = " " + _("no number there")
        lines.append([Ink(f"{one.letter} ", one.look), Ink(fit(_name(one), room)), Ink(cells)])
    return lines


def legend_in_short(series: Sequence[Series], width: int, title: str) -> list[Line]:
    """The title, then field and newest number of each, in at most two lines."""
    lines: list[Line] = [[Ink(fit(title, min(width, cell_len(title))), "strong")]]
    room = width - cell_len(title)
    for place, one in enumerate(series):
        number = number_text(one.history.last) if one.is_number else UNKNOWN
        text = f" {one.field.name} {number}"
        if cell_len(text) + 3 > room:
            rest = len(series) - place
            if len(lines) > 1 or cell_len(text) + 3 > width:
                lines[-1].append(Ink(fit(f" +{rest}", max(0, room)), "muted"))
                break
            lines.append([])
            room = width
        lines[-1] += [Ink("  " if lines[-1] else ""), Ink(one.letter, one.look), Ink(text)]
        room -= cell_len(text) + 3
    return lines


def number_text(number: float | None) -> str:
    """A number with five significant digits; nan and infinities by name."""
    if number is None:
        return UNKNOWN
    if not math.isfinite(number):
        return str(number)
    if number and not TINY <= abs(number) < HUGE:
        return f"{number:.2e}"
    whole = len(str(int(abs(number))))
    return f"{number:.{max(0, FIGURES - whole)}f}"


def _name(one: Series) -> str:
    return f"{plain(one.field.topic, 200)} {one.field.name}"
