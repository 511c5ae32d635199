"""Room, path, rays, goal and robot on a canvas."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from robot.world.world import Body, SimulatedSonar
from tui.panels.map.canvas import Canvas
from tui.panels.map.reading import OCCUPIED_FROM
from tui.panels.sonar.bar import ink_of
from tui.panels.sonar.words import COURSE, Bounds

if TYPE_CHECKING:
    from robot.motion.odometry import Point, Pose
    from tui.panels import dots
    from tui.panels.map.reading import OccupancyGrid
    from tui.panels.map.viewport import Viewport

FRONT, REAR = "front", "rear"
BODY = Body()
MAX_RANGE_M = SimulatedSonar().farthest_m
"""The length of a cone in which nothing was detected."""
LONGEST_RAY_M = 1e4
"""A longer ray is drawn with this length: its end is outside every map."""
CONE_RAD = 0.06
"""Half of the angle of the cone; wider than the real one, so that it is recognisable."""
BROKEN_M = 0.6
"""Length of the dashed ray of a sonar without a valid reading."""
PATH, GOAL, ROBOT, TRUTH, WALL, GRID = "second", "good", "accent", "muted", "", "muted"
GOAL_SIGN, HIT_SIGN, BLIND_SIGN, FREE_SIGN = "◎", "●", "?", "∠"
_DRAWN_FROM = 8.0
"""In dots; a smaller robot is drawn as a dart large enough to be seen."""
_APART = 2.0
"""In dots; a true pose closer to the robot would only blur it."""
_HULL_FROM = 20.0
"""In dots; a larger robot is drawn with its outline around the dart."""
_HULL = ((-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0))
_DART = ((1.0, 0.0), (-0.9, 1.0), (-0.45, 0.0), (-0.9, -1.0))
_WIDER = 1.35
"""A dart that stands for the whole robot is wider than the robot by this factor."""
_GRID_CELLS = 4
"""Minimum distance between the dots of the grid, in cells."""


@dataclass(frozen=True)
class Scene:
    """Everything that moves, that is all but the room and the path."""

    pose: Pose
    truth: Pose | None = None
    goal: Point | None = None
    rays: dict[str, float] = field(default_factory=dict)
    """`FRONT` and `REAR` to metres according to REP-117."""
    bounds: Bounds = COURSE
    """Which of these distances count as near."""


def ray_origin(pose: Pose, place: str) -> tuple[dots.Point, float]:
    """Position of a sonar at the bumper in metres, and its direction."""
    offset_m = BODY.length_m - BODY.behind_m if place == FRONT else -BODY.behind_m
    x_m = pose.x_m + offset_m * math.cos(pose.heading_rad)
    y_m = pose.y_m + offset_m * math.sin(pose.heading_rad)
    return (x_m, y_m), pose.heading_rad + (0.0 if place == FRONT else math.pi)


def along(start: dots.Point, heading_rad: float, metres: float) -> dots.Point:
    """The point at this distance in a direction."""
    return start[0] + metres * math.cos(heading_rad), start[1] + metres * math.sin(heading_rad)


def draw_grid(canvas: Canvas, view: Viewport, step_m: float) -> None:
    """Draw a dot at every crossing of a grid, one of them at the origin."""
    if math.isinf(step_m):
        return
    across, up = canvas.width / view.dots_per_m, canvas.height / view.dots_per_m
    first = math.ceil(view.left_m / step_m), math.ceil((view.top_m - up) / step_m)
    x, y = np.meshgrid(
        np.arange(first[0], math.floor((view.left_m + across) / step_m) + 1) * step_m,
        np.arange(first[1], math.floor(view.top_m / step_m) + 1) * step_m,
    )
    canvas.dots((x - view.left_m) * view.dots_per_m, (view.top_m - y) * view.dots_per_m, GRID)


def grid_step_m(view: Viewport) -> float:
    """The distance between the dots of the grid: 1 m, or 2, 5, 10, ... if that is too close."""
    for step_m in (digit * 10.0**power for power in range(8) for digit in (1, 2, 5)):
        if step_m * view.dots_per_m >= 2 * _GRID_CELLS:
            return step_m
    return math.inf


def draw_occupancy(canvas: Canvas, view: Viewport, occupancy: OccupancyGrid) -> None:
    """Draw the obstacles in the room."""
    if occupancy.cell_m * view.dots_per_m <= 1.0:
        rows, columns = np.nonzero(occupancy.cells >= OCCUPIED_FROM)
        x_m, y_m = occupancy.centres(rows.astype(np.float64), columns.astype(np.float64))
        canvas.dots((x_m - view.left_m) * view.dots_per_m, (view.top_m - y_m) * view.dots_per_m, WALL)
        return
    x, y = np.meshgrid(np.arange(canvas.width) + 0.5, np.arange(canvas.height) + 0.5)
    stands = occupancy.occupied_at(view.left_m + x / view.dots_per_m, view.top_m - y / view.dots_per_m)
    canvas.dots(x[stands], y[stands], WALL)


def draw_path(canvas: Canvas, view: Viewport, piece: list[dots.Point]) -> None:
    """Draw a piece of the path."""
    for start, end in pairwise(piece):
        canvas.line(view.place(*start), view.place(*end), PATH)


def draw_scene(canvas: Canvas, view: Viewport, scene: Scene) -> None:
    """Draw everything that moves, the robot last."""
    for place, metres in scene.rays.items():
        _draw_ray(canvas, view, scene.pose, place, metres, ink_of(metres, scene.bounds))
    if scene.goal is not None:
        canvas.sign(view.place(scene.goal.x_m, scene.goal.y_m), GOAL_SIGN, GOAL)
    if scene.truth is not None:
        truth, believed = robot_corners(view, scene.truth), robot_corners(view, scene.pose)
        if max(map(math.dist, truth, believed)) >= _APART:
            canvas.outline(truth, TRUTH)
    _draw_robot(canvas, view, scene.pose)


def _draw_ray(canvas: Canvas, view: Viewport, pose: Pose, place: str, metres: float, look: str) -> None:
    start, heading = ray_origin(pose, place)
    begin = view.place(*start)
    if math.isnan(metres):
        end = view.place(*along(start, heading, BROKEN_M))
        canvas.line(begin, end, look, (1, 2))
        canvas.sign(end, BLIND_SIGN, look)
    elif metres == math.inf:
        ends = [
            view.place(*along(start, heading + side * CONE_RAD, MAX_RANGE_M)) for side in (-1.0, -0.5, 0.0, 0.5, 1.0)
        ]
        for edge in (ends[0], ends[-1]):
            canvas.line(begin, edge, look, (1, 1))
        for one, other in pairwise(ends):
            canvas.line(one, other, look)
    else:
        end = view.place(*along(start, heading, min(max(0.0, metres), LONGEST_RAY_M)))
        canvas.line(begin, end, look)
        canvas.sign(end, HIT_SIGN, look)


def _draw_robot(canvas: Canvas, view: Viewport, pose: Pose) -> None:
    """Draw a dart that points ahead, inside the outline of the robot if that is visible."""
    nose, left, notch, right = robot_corners(view, pose)
    canvas.fill([nose, left, notch], ROBOT)
    canvas.fill([nose, notch, right], ROBOT)
    if _life_dots(view) >= _HULL_FROM:
        canvas.outline(_placed(view, pose, _HULL, 1.0, 1.0), ROBOT)


def robot_corners(view: Viewport, pose: Pose) -> list[dots.Point]:
    """Nose, left, notch and right of the dart; larger than life if it would be too small."""
    life = _life_dots(view)
    size = max(1.0, _DRAWN_FROM / life)
    return _placed(view, pose, _DART, size, size if life >= _HULL_FROM else size * _WIDER)


def _life_dots(view: Viewport) -> float:
    return BODY.length_m * view.dots_per_m


def _placed(
    view: Viewport, pose: Pose, shape: tuple[dots.Point, ...], longer: float, wider: float
) -> list[dots.Point]:
    """Place a shape, given in halves of the robot's length and width about its centre."""
    middle_m = BODY.length_m / 2 - BODY.behind_m
    cos, sin = math.cos(pose.heading_rad), math.sin(pose.heading_rad)
    corners = []
    for ahead, left in shape:
        x = middle_m + ahead * longer * BODY.length_m / 2
        y = left * wider * BODY.width_m / 2
        corners.append(view.place(pose.x_m + x * cos - y * sin, pose.y_m + x * sin + y * cos))
    return corners
