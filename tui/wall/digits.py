"""Digits of seven segments, as large as there is room, drawn in halves of cells.

Half a cell of a terminal is about as high as it is wide. Sizes are in such halves.
"""

from __future__ import annotations

from typing import NamedTuple

_SEGMENTS = {
    "0": "abcdef",
    "1": "bc",
    "2": "abged",
    "3": "abgcd",
    "4": "fgbc",
    "5": "afgcd",
    "6": "afgedc",
    "7": "abc",
    "8": "abcdefg",
    "9": "abcdfg",
    "e": "adefg",
    "-": "g",
    ".": "",
    ",": "",
    "∞": "",
}
"""Segments by their usual letters: a to f clockwise from the top, g in the middle."""
LEAST_HIGH = 6
WIDTH = 0.55
"""Of a digit, as a share of its height."""
STROKE = 6
"""How many strokes wide a digit is high."""
_HALVES = {(0, 0): " ", (1, 0): "▀", (0, 1): "▄", (1, 1): "█"}


class DigitSize(NamedTuple):
    """The size of a digit."""

    high: int
    wide: int
    thick: int


def size_for(texts: tuple[str, ...], columns: int, rows: int) -> DigitSize | None:
    """Return the largest size at which each text fits; None if there is none, or no such sign."""
    if not all(sign in _SEGMENTS for text in texts for sign in text):
        return None
    for high in range(2 * rows, LEAST_HIGH - 1, -1):
        size = DigitSize(high, round(WIDTH * high), max(1, round(high / STROKE)))
        if all(_width(text, size) <= columns for text in texts):
            return size
    return None


def digit_lines(text: str, size: DigitSize) -> list[str]:
    """Return a text in this size as rows of cells."""
    pixels = [[0] * _width(text, size) for _row in range(size.high + size.high % 2)]
    x = 0
    for sign in text:
        for left, top, wide, high in _bars(sign, size):
            for row in pixels[top : top + high]:
                row[x + left : x + left + wide] = [1] * wide
        x += _sign_width(sign, size) + size.thick
    return [
        "".join(_HALVES[both] for both in zip(upper, lower, strict=True))
        for upper, lower in zip(pixels[::2], pixels[1::2], strict=True)
    ]


def _width(text: str, size: DigitSize) -> int:
    return sum(_sign_width(sign, size) + size.thick for sign in text) - size.thick if text else 0


def _sign_width(sign: str, size: DigitSize) -> int:
    if sign in ".,":
        return size.thick
    if sign == "∞":
        return 2 * size.wide - size.thick
    return (2 * size.wide + 1) // 3 if sign == "-" else size.wide


def _bars(sign: str, size: DigitSize) -> list[tuple[int, int, int, int]]:
    """Return the bars of a sign: left, top, width, height."""
    high, wide, thick = size
    middle, right, bottom = (high - thick) // 2, wide - thick, high - thick
    if sign == ".":
        return [(0, bottom, thick, thick)]
    if sign == ",":
        return [(0, bottom - thick, thick, 2 * thick)]
    if sign == "∞":
        top, low = high // 4, high - high // 4 - thick
        across = [(0, y, 2 * wide - thick, thick) for y in (top, low)]
        return across + [(x, top, thick, low - top) for x in (0, right, 2 * right)]
    bars = {
        "a": (0, 0, wide, thick),
        "b": (right, 0, thick, middle + thick),
        "c": (right, middle, thick, high - middle),
        "d": (0, bottom, wide, thick),
        "e": (0, middle, thick, high - middle),
        "f": (0, 0, thick, middle + thick),
        "g": (0, middle, _sign_width(sign, size), thick),
    }
    return [bars[segment] for segment in _SEGMENTS[sign]]
