"""Formatting numbers for the screen, however large: a node may send any number.

They are written as the current language requires: `0,36` in Russian.
"""

from __future__ import annotations

import math

from text.i18n import decimal

PLAIN_BELOW = 1e6
"""Larger numbers are written with an exponent: three hundred digits help nobody."""


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
    """`1e308`: three digits, without redundant signs or zeros in the exponent."""
    return decimal(f"{value:.3g}".replace("e+0", "e").replace("e+", "e"))


def whole(value: float) -> str:
    """`45`, the nearest whole number; formatted by `figure` where that makes no sense."""
    return str(round(value)) if abs(value) < PLAIN_BELOW else figure(value, 0)


def elapsed(value: float) -> str:
    """`45`, the full seconds, minutes, ... that have passed; otherwise formatted by `figure`."""
    return str(int(value)) if abs(value) < PLAIN_BELOW else figure(value, 0)
