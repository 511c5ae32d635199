"""A picture as rows of half-block characters: two pixels in each cell, upper and lower.

This imports numpy, so widgets on the first screen import it only when there is a picture.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from rich.color import Color
from rich.segment import Segment
from rich.style import Style

if TYPE_CHECKING:
    from numpy.typing import NDArray

Pixels: TypeAlias = "NDArray[np.uint8]"
"""Shape (height, width, 3), RGB."""

UPPER_HALF = "▀"
FULL_DEPTH = 8
JUMP = 4
"""A run of unchanged cells this short is cheaper to redraw than to skip."""
MOST_STYLES = 4096
MOST_COLOURS = 8192
"""Kept for the next picture: three megabytes, and two for the styles."""


def fitting_size(width: int, height: int, columns: int, rows: int) -> tuple[int, int]:
    """Width and height in pixels of the largest picture of this shape within the given cells.

    A cell is about twice as high as wide, so half of one is about square. The height is even.
    """
    scale = min(columns / width, 2 * rows / height)
    fit_width = min(columns, max(1, round(width * scale)))
    fit_height = min(2 * rows, max(2, 2 * round(height * scale / 2)))
    return fit_width, fit_height


def coarser(picture: Pixels, bits: int) -> Pixels:
    """The picture with this many bits in each channel; black stays black and white stays white."""
    if bits >= FULL_DEPTH:
        return picture
    levels = (1 << bits) - 1
    table = (np.arange(256) * levels + 127) // 255 * 255 // levels
    coarse: Pixels = table.astype(np.uint8)[picture]
    return coarse


def steadied(before: Pixels, fresh: Pixels, bits: int) -> Pixels:
    """The new picture, coarser, keeping pixels of the previous one where they hardly differ.

    A pixel between two levels of colour must not flicker with the camera's noise.
    """
    moved = np.abs(fresh.astype(np.int16) - before) > (256 >> bits)
    now: Pixels = np.where(moved.any(axis=2, keepdims=True), coarser(fresh, bits), before)
    return now


def changed_spans(before: Pixels, after: Pixels) -> list[tuple[int, int, int]]:
    """Where two pictures of the same shape differ, as (row of cells, first column, columns).

    Differences that are close together in a row form one span: moving the cursor costs bytes too.
    """
    differ = (before != after).any(axis=2)
    cells = differ[0::2] | differ[1::2]
    spans: list[tuple[int, int, int]] = []
    for row in np.flatnonzero(cells.any(axis=1)):
        columns = np.flatnonzero(cells[row])
        breaks = np.flatnonzero(np.diff(columns) > JUMP)
        starts = columns[np.concatenate(([0], breaks + 1))]
        ends = columns[np.concatenate((breaks, [len(columns) - 1]))]
        spans.extend((int(row), int(a), int(b - a + 1)) for a, b in zip(starts, ends, strict=True))
    return spans


def row_segments(picture: Pixels, row: int) -> list[Segment]:
    """One row of cells of a picture of even height; equal neighbours share a segment."""
    wide = picture[2 * row : 2 * row + 2].astype(np.int64)
    packed = (wide[..., 0] << 16) | (wide[..., 1] << 8) | wide[..., 2]
    pairs = (packed[0] << 24) | packed[1]
    starts = np.flatnonzero(np.diff(pairs, prepend=-1))
    ends = np.append(starts[1:], len(pairs))
    return [_segment(int(pairs[start]), int(end - start)) for start, end in zip(starts, ends, strict=True)]


def _segment(pair: int, cells: int) -> Segment:
    upper, lower = pair >> 24, pair & 0xFFFFFF
    if upper == lower:
        return Segment(" " * cells, _style(None, lower))
    return Segment(UPPER_HALF * cells, _style(upper, lower))


@lru_cache(maxsize=MOST_STYLES)
def _style(upper: int | None, lower: int) -> Style:
    foreground = None if upper is None else _color(upper)
    return Style.from_color(foreground, _color(lower))


@lru_cache(maxsize=MOST_COLOURS)
def _color(packed: int) -> Color:
    return Color.from_rgb(packed >> 16, packed >> 8 & 255, packed & 255)
