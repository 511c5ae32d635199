"""Colours of the simulated room: the paint on its walls, its floor and its boxes.

A room has four walls of different colours, with a window ahead of the start, a door on the left,
pictures on the right and shelves behind, so that a camera picture shows where the robot looks.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from robot.world.room import Box

    Canvas = NDArray[np.uint8]
    Colour = tuple[int, int, int]

PIXEL_M = 0.02
ROOM_HEIGHT_M = 2.5
EAST, NORTH, WEST, SOUTH, FLOOR, CEILING = range(6)
"""Surfaces of a room; a wall's first column is on its left, its first row at the floor."""
ALONG, ACROSS, TOP = range(3)
"""Surfaces of a box: its two ends, its two sides, and the top."""

_EAST, _NORTH, _WEST, _SOUTH = (222, 210, 180), (186, 204, 178), (178, 192, 214), (222, 190, 168)
_CEILING, _LAMP = (226, 226, 220), (255, 255, 236)
_SKIRTING, _WHITE, _WOOD, _DARK = (92, 68, 52), (244, 244, 240), (122, 80, 48), (56, 40, 30)
_SKY, _GRASS, _BRASS = (136, 190, 236), (104, 148, 84), (216, 180, 88)
_TILES: tuple[Colour, Colour] = (178, 142, 102), (158, 122, 84)
_TILE_M = 0.5
_RUG, _RUG_BORDER = (150, 58, 62), (214, 176, 120)
_BOOKS: tuple[Colour, ...] = (
    (168, 48, 44), (44, 84, 148), (60, 120, 72), (204, 156, 52), (112, 64, 120), (220, 212, 196),
)  # fmt: skip
_BOXES: tuple[tuple[Colour, float], ...] = (
    ((196, 148, 88), 0.35), ((60, 104, 168), 0.60), ((84, 148, 92), 0.20), ((188, 84, 72), 0.45),
)  # fmt: skip
"""Colour and height, alternating."""
_SHARES = {ALONG: 0.86, ACROSS: 0.68, TOP: 1.0}
"""Brightness of the surfaces of a box."""


@dataclass(frozen=True)
class SurfaceTextures:
    """All surfaces in one array, row by row."""

    colours: NDArray[np.uint8]
    """Red, green and blue of every texel."""
    begins: NDArray[np.int32]
    """The first texel of each surface."""
    columns: NDArray[np.int32]
    rows: NDArray[np.int32]

    @classmethod
    def of(cls, canvases: Sequence[Canvas]) -> SurfaceTextures:
        sizes = [len(canvas) * canvas.shape[1] for canvas in canvases]
        return cls(
            np.concatenate([canvas.reshape(-1, 3) for canvas in canvases]),
            np.cumsum([0, *sizes[:-1]], dtype=np.int32),
            np.array([canvas.shape[1] for canvas in canvases], np.int32),
            np.array([len(canvas) for canvas in canvases], np.int32),
        )


def box_height_m(number: int) -> float:
    """Return the height of a box in the room."""
    return _BOXES[number % len(_BOXES)][1]


def paint_room(walls: Box) -> SurfaceTextures:
    """Paint the four walls, the floor and the ceiling of a room."""
    east, west = (_wall(walls.width_m, colour) for colour in (_EAST, _WEST))
    north, south = (_wall(walls.length_m, colour) for colour in (_NORTH, _SOUTH))
    _window(east, walls.width_m / 2 - 0.9)
    _door(north, walls.length_m / 2 + 0.1)
    _shelves(west, walls.width_m / 2 - 0.8)
    _picture(south, walls.length_m / 2 - 1.1, _SKY, _GRASS)
    _picture(south, walls.length_m / 2 + 0.4, _RUG_BORDER, _RUG)
    floor = _floor(walls.length_m, walls.width_m)
    ceiling = _canvas(walls.length_m, walls.width_m, _CEILING)
    _fill(ceiling, (walls.length_m / 2 - 0.3, walls.length_m / 2 + 0.3), (0.5, 1.1), _LAMP)
    return SurfaceTextures.of([east, north, west, south, floor, ceiling])


def paint_box(number: int, box: Box) -> SurfaceTextures:
    """Paint the sides of a box: darker edges, and a stripe like tape."""
    colour, height_m = _BOXES[number % len(_BOXES)]
    sizes = {ALONG: (box.width_m, height_m), ACROSS: (box.length_m, height_m), TOP: (box.length_m, box.width_m)}
    return SurfaceTextures.of([_side(sizes[side], colour, _SHARES[side]) for side in sizes])


def _side(size_m: tuple[float, float], colour: Colour, share: float) -> Canvas:
    side = _canvas(*size_m, tuple(round(part * 0.6) for part in colour))
    side[1:-1, 1:-1] = colour
    middle = side.shape[0] // 2
    side[middle - 1 : middle + 1] = [min(255, part + 36) for part in colour]
    return (side * share).astype(np.uint8)


def _canvas(across_m: float, up_m: float, colour: tuple[int, ...]) -> Canvas:
    size = max(3, round(up_m / PIXEL_M)), max(3, round(across_m / PIXEL_M))
    return np.full((*size, 3), colour, np.uint8)


def _fill(canvas: Canvas, across_m: tuple[float, float], up_m: tuple[float, float], colour: Colour) -> None:
    columns, rows = (slice(*(max(0, round(end / PIXEL_M)) for end in ends)) for ends in (across_m, up_m))
    canvas[rows, columns] = colour


def _wall(length_m: float, colour: Colour) -> Canvas:
    wall = _canvas(length_m, ROOM_HEIGHT_M, colour)
    _fill(wall, (0.0, length_m), (0.0, 0.1), _SKIRTING)
    # Corners catch less light.
    wall[:, :3] = wall[:, -3:] = (np.array(colour) * 0.8).astype(np.uint8)
    return wall


def _window(wall: Canvas, left_m: float) -> None:
    _fill(wall, (left_m - 0.1, left_m + 1.5), (0.7, 1.95), _WHITE)
    for pane_m in (left_m, left_m + 0.73):
        _fill(wall, (pane_m, pane_m + 0.67), (0.8, 1.85), _SKY)
        _fill(wall, (pane_m, pane_m + 0.67), (0.8, 1.05), _GRASS)
    _fill(wall, (left_m - 0.2, left_m + 1.6), (0.64, 0.7), _WOOD)


def _door(wall: Canvas, left_m: float) -> None:
    _fill(wall, (left_m - 0.08, left_m + 0.98), (0.0, 2.08), _DARK)
    _fill(wall, (left_m, left_m + 0.9), (0.0, 2.0), _WOOD)
    for low_m, high_m in ((0.2, 0.9), (1.15, 1.85)):
        _fill(wall, (left_m + 0.15, left_m + 0.75), (low_m, high_m), _DARK)
        _fill(wall, (left_m + 0.18, left_m + 0.72), (low_m + 0.03, high_m - 0.03), _WOOD)
    _fill(wall, (left_m + 0.76, left_m + 0.86), (0.98, 1.06), _BRASS)


def _shelves(wall: Canvas, left_m: float) -> None:
    _fill(wall, (left_m, left_m + 1.6), (0.0, 1.8), _WOOD)
    for shelf in range(4):
        low_m = 0.08 + 0.44 * shelf
        _fill(wall, (left_m + 0.05, left_m + 1.55), (low_m, low_m + 0.38), _DARK)
        for book in range(14):
            at_m, tall_m = left_m + 0.08 + 0.1 * book, 0.24 + 0.04 * ((book * 5 + shelf) % 4)
            colour = _BOOKS[(book * 7 + shelf * 3) % len(_BOOKS)]
            _fill(wall, (at_m, at_m + 0.08), (low_m, low_m + tall_m), colour)


def _picture(wall: Canvas, left_m: float, above: Colour, below: Colour) -> None:
    _fill(wall, (left_m - 0.06, left_m + 0.76), (0.94, 1.56), _DARK)
    _fill(wall, (left_m, left_m + 0.7), (1.0, 1.5), above)
    _fill(wall, (left_m, left_m + 0.7), (1.0, 1.2), below)


def _floor(length_m: float, width_m: float) -> Canvas:
    floor = _canvas(length_m, width_m, _TILES[0])
    rows, columns = np.indices(floor.shape[:2]) * PIXEL_M // _TILE_M
    floor[(rows + columns) % 2 == 1] = _TILES[1]
    middle_m, across_m = length_m / 2, width_m / 2
    for edge_m, colour in ((0.0, _RUG_BORDER), (0.08, _RUG)):
        along = middle_m - 0.9 + edge_m, middle_m + 0.9 - edge_m
        _fill(floor, along, (across_m - 0.6 + edge_m, across_m + 0.6 - edge_m), colour)
    return floor
