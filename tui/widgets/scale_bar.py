"""A bar that says how long a round number of metres is on the picture above it."""

from __future__ import annotations

import math

from text.i18n import _, decimal
from tui.widgets.drawing import Ink, Line

BAR_M = (1, 2, 5)
"""First digits of the length of a scale bar."""
BAR_CELLS = 12
"""Maximum length of the scale bar."""


def bar_length_m(dots_per_m: float, cells: int) -> float:
    """The longest of 1, 2, 5, 10, ... metres, or fractions, that fits into this many cells."""
    most_m = max(1, cells) * 2 / dots_per_m
    power = 10.0 ** math.floor(math.log10(most_m))
    return max(digit * power for digit in BAR_M if digit * power <= most_m * (1 + 1e-9))


def scale_bar(dots_per_m: float) -> Line:
    """A bar for a round number of metres, as long as that is in the picture."""
    metres = bar_length_m(dots_per_m, BAR_CELLS)
    cells = max(1, round(metres * dots_per_m / 2))
    bar = "├" + "─" * (cells - 2) + "┤" if cells > 1 else "│"
    return [Ink(f"{bar} "), Ink(_("{metres} m").format(metres=decimal(f"{metres:g}")), "strong")]
