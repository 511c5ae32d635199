"""What a camera in the simulated room sees: every pixel is a traced ray.

Drawn coarsely and scaled up: a few milliseconds per picture, with numpy alone. The same camera pose
in the same room gives the same picture.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from robot.motion.odometry import Pose
from robot.world.world import Box, Room

if TYPE_CHECKING:
    Canvas = NDArray[np.uint8]
    Colour = tuple[int, int, int]
    Floats = NDArray[np.float32]
    Whole = NDArray[np.int32]

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
    """Paint the four walls, the floor and the ceiling of a room.

    The walls have different colours, with a window ahead of the start, a door on the left, pictures on
    the right and shelves behind, so that a camera picture shows where the robot looks.
    """
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


_Way = TypeVar("_Way", float, "NDArray[np.float32]")

AHEAD_M, HEIGHT_M = 0.15, 0.25
"""Position of the camera: in front of the rear axle, and above the floor."""
FIELD_RAD = 1.22
"""Field of view from the left edge of the picture to the right one."""
_COARSE = 2
_NEAR_M = 0.05
_DARKEST, _DARK_PER_M = 130, 20
"""Brightness of 256, and how much darker each metre makes it."""


@dataclass(frozen=True)
class CameraPose:
    """Position and direction of a camera."""

    x_m: float
    y_m: float
    z_m: float
    heading_rad: float
    tilt_rad: float = 0.0
    """+ is up."""

    @classmethod
    def on(cls, pose: Pose, pan_rad: float = 0.0, tilt_rad: float = 0.0) -> CameraPose:
        """Return the camera of a robot at a pose, with its head turned."""
        x_m = pose.x_m + AHEAD_M * math.cos(pose.heading_rad)
        y_m = pose.y_m + AHEAD_M * math.sin(pose.heading_rad)
        return cls(x_m, y_m, HEIGHT_M, pose.heading_rad + pan_rad, tilt_rad)


class _Rays(NamedTuple):
    """Origin and direction of the ray for each pixel: along a box, across it, and up."""

    begin: tuple[float, float, float]
    along: Floats
    across: Floats
    up: Floats

    def cut(self, part: tuple[slice, slice]) -> _Rays:
        """Return the rays of a part of the picture."""
        return _Rays(self.begin, self.along[part], self.across[part], self.up[part])

    def seen_from(self, box: Box) -> _Rays:
        """Return the same rays in a box's own axes."""
        x_m, y_m = _turned(self.begin[0] - box.x_m, self.begin[1] - box.y_m, -box.heading_rad)
        along, across = _turned(self.along, self.across, -box.heading_rad)
        return _Rays((x_m, y_m, self.begin[2]), along, across, self.up)


class RoomView:
    """Draws pictures of one size."""

    def __init__(self, room: Room, height: int, width: int, *, blue_first: bool = True) -> None:
        self._room, self._width = room, width
        rows, columns = -(-height // _COARSE), -(-width // _COARSE)
        self._most_left = math.tan(FIELD_RAD / 2)
        self._most_up = self._most_left * height / width
        left = self._most_left * np.linspace(1, -1, columns, dtype=np.float32)
        up = self._most_up * np.linspace(1, -1, rows, dtype=np.float32)
        self._left, self._up = np.meshgrid(left, up)
        self._walls = paint_room(room.walls)
        self._boxes = [paint_box(number, box) for number, box in enumerate(room.boxes)]
        paints = [self._walls, *self._boxes]
        order = slice(None, None, -1 if blue_first else 1)
        self._colours = np.concatenate([paint.colours for paint in paints])[:, order].copy()
        self._begins = np.cumsum([0, *(len(paint.colours) for paint in paints)]).tolist()

    def draw(self, picture: NDArray[np.uint8], eye: CameraPose) -> None:
        """Draw into an array of shape (height, width, 3)."""
        rays = self._rays(eye)
        # A ray along a wall never meets it: the inf or nan of that division does no harm.
        with np.errstate(divide="ignore", invalid="ignore"):
            reach, spots = _see_walls(rays.seen_from(self._room.walls), self._room.walls, self._walls)
            for number, box in enumerate(self._room.boxes):
                part = self._part_with(box, number, eye)
                if part is not None:
                    paint, begin = self._boxes[number], self._begins[1 + number]
                    seen = rays.cut(part).seen_from(box)
                    sides_m = box.length_m, box.width_m, box_height_m(number)
                    _see_box(seen, sides_m, paint, begin, reach[part], spots[part])
        light = (256 - np.minimum(reach * _DARK_PER_M, 256 - _DARKEST)).astype(np.uint16)
        colours = self._colours.take(spots, axis=0)
        coarse = (colours * light[:, :, None] >> 8).astype(np.uint8)
        rows = coarse.repeat(_COARSE, axis=1)[:, : self._width]
        for row in range(_COARSE):
            every = picture[row::_COARSE]
            every[:] = rows[: len(every)]

    def _part_with(self, box: Box, number: int, eye: CameraPose) -> tuple[slice, slice] | None:
        """Return the rows and columns in which a box may be visible, None if there are none."""
        cos, sin = math.cos(eye.tilt_rad), math.sin(eye.tilt_rad)
        floor = [_turned(x_m - eye.x_m, y_m - eye.y_m, -eye.heading_rad) for x_m, y_m in box.corners()]
        depth, left, up = np.array(
            [
                (cos * ahead + sin * z_m, left, cos * z_m - sin * ahead)
                for ahead, left in floor
                for z_m in (-eye.z_m, box_height_m(number) - eye.z_m)
            ]
        ).T
        beyond = (
            *(depth * self._most_left - side for side in (left, -left)),
            *(depth * self._most_up - side for side in (up, -up)),
        )
        if any((gap < 0).all() for gap in beyond):
            return None
        rows, columns = self._left.shape
        if depth.min() < _NEAR_M:
            return slice(0, rows), slice(0, columns)
        return (_between(up / depth / self._most_up, rows), _between(left / depth / self._most_left, columns))

    def _rays(self, eye: CameraPose) -> _Rays:
        cos, sin = math.cos(eye.tilt_rad), math.sin(eye.tilt_rad)
        ahead, up = cos - sin * self._up, sin + cos * self._up
        along, across = _turned(ahead, self._left, eye.heading_rad)
        return _Rays((eye.x_m, eye.y_m, eye.z_m), along, across, up)


def _see_walls(rays: _Rays, walls: Box, paint: SurfaceTextures) -> tuple[Floats, Whole]:
    """Return how far each ray goes inside the room, and which texel it meets."""
    half, wide = walls.length_m / 2, walls.width_m / 2
    (x_m, y_m, z_m), along, across, up = rays
    to_end = (np.copysign(np.float32(half), along) - x_m) / along
    to_side = (np.copysign(np.float32(wide), across) - y_m) / across
    middle = ROOM_HEIGHT_M / 2
    to_level = (np.copysign(np.float32(middle), up) + (middle - z_m)) / up
    reach = np.minimum(np.minimum(to_end, to_side), to_level)
    spots = np.empty(reach.shape, np.int32)
    end, side = reach == to_end, reach == to_side
    level = ~(end | side)
    for surface, met, column, row in (
        (EAST, end & (along > 0), (wide - y_m, across, -1), (z_m, up, 1)),
        (WEST, end & (along <= 0), (wide + y_m, across, 1), (z_m, up, 1)),
        (NORTH, side & ~end & (across > 0), (half + x_m, along, 1), (z_m, up, 1)),
        (SOUTH, side & ~end & (across <= 0), (half - x_m, along, -1), (z_m, up, 1)),
        (FLOOR, level & (up <= 0), (half + x_m, along, 1), (wide + y_m, across, 1)),
        (CEILING, level & (up > 0), (half + x_m, along, 1), (wide + y_m, across, 1)),
    ):
        if met.any():
            far = reach[met]
            across_m, up_m = (at_m + sign * far * way[met] for at_m, way, sign in (column, row))
            spots[met] = _spots(paint, surface, across_m, up_m)
    return reach, spots


def _see_box(
    rays: _Rays, sides_m: tuple[float, float, float], paint: SurfaceTextures, begin: int, reach: Floats, spots: Whole
) -> None:
    """Draw a box over what is farther away, in `reach` and in `spots`."""
    length_m, width_m, height_m = sides_m
    (x_m, y_m, z_m), *ways = rays
    nears, fars = [], []
    for at_m, low_m, high_m, way in (
        (x_m, -length_m / 2, length_m / 2, ways[0]),
        (y_m, -width_m / 2, width_m / 2, ways[1]),
        (z_m, 0.0, height_m, ways[2]),
    ):
        inverse = 1 / way
        one, other = (low_m - at_m) * inverse, (high_m - at_m) * inverse
        nears.append(np.minimum(one, other))
        fars.append(np.maximum(one, other))
    near = np.maximum(np.maximum(nears[ALONG], nears[ACROSS]), nears[TOP])
    far = np.minimum(np.minimum(fars[ALONG], fars[ACROSS]), fars[TOP])
    met = (near < far) & (near > 0) & (near < reach)
    if not met.any():
        return
    near = near[met]
    x, y, z = (at_m + near * way[met] for at_m, way in zip((x_m, y_m, z_m), ways, strict=True))
    surface = np.where(near == nears[ACROSS][met], ACROSS, TOP)
    surface = np.where(near == nears[ALONG][met], ALONG, surface)
    column = np.where(surface == ALONG, y + width_m / 2, x + length_m / 2)
    row = np.where(surface == TOP, y + width_m / 2, z)
    reach[met] = near
    spots[met] = begin + _spots(paint, surface, column, row)


def _spots(paint: SurfaceTextures, surface: Whole | int, column_m: Floats, row_m: Floats) -> Whole:
    columns, rows = paint.columns[surface], paint.rows[surface]
    column = np.clip((column_m / PIXEL_M).astype(np.int32), 0, columns - 1)
    row = np.clip((row_m / PIXEL_M).astype(np.int32), 0, rows - 1)
    return paint.begins[surface] + row * columns + column


def _turned(along: _Way, across: _Way, angle_rad: float) -> tuple[_Way, _Way]:
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    return along * cos - across * sin, along * sin + across * cos


def _between(places: NDArray[np.float64], count: int) -> slice:
    """Return the pixels between places of a picture that spans 1 to -1, plus one more."""
    begin, end = ((1 - place) / 2 * (count - 1) for place in (places.max(), places.min()))
    return slice(max(0, math.floor(begin) - 1), min(count, math.ceil(end) + 2))
