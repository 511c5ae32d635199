"""Numbers as they are written on the screen, however large: anybody may send any number.

In the language spoken: `0,36` in Russian.
"""

from __future__ import annotations

import math

from text.i18n import decimal

PLAIN_BELOW = 1e6
"""From here on a number is written with an exponent: three hundred digits help nobody."""


def figure(value: float, decimals: int = 2) -> str:
    """`-0.25`; `1e308` where that would be too long; `---` for not a number, `∞` for infinity."""
    if math.isnan(value):
        return "---"
    if math.isinf(value):
        return "∞" if value > 0 else "-∞"
    if abs(value) < PLAIN_BELOW:
        return decimal(f"{value:.{decimals}f}")
    return short(value)


def short(value: float) -> str:
    """`1e308`: three digits, and no sign or zeros in the exponent that say nothing."""
    return decimal(f"{value:.3g}".replace("e+0", "e").replace("e+", "e"))


def whole(value: float) -> str:
    """`45`, the nearest whole number; written as by `figure` where that is no use."""
    return str(round(value)) if abs(value) < PLAIN_BELOW else figure(value, 0)


def elapsed(value: float) -> str:
    """`45`, the whole seconds, minutes, ... that have passed; written as by `figure` else."""
    return str(int(value)) if abs(value) < PLAIN_BELOW else figure(value, 0)
