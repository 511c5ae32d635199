"""The map's floor: which part is shown, what messages say of it, and everything that is drawn on it.

Seen from above as on paper: x to the right and y upwards, so that a left turn appears as a left
turn. A metre has the same length in both directions.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot.motion.odometry import Point as Place
from robot.motion.odometry import Pose, yaw_from_quaternion
from robot.world.world import Body, SimulatedSonar
from space.reading.fields import NotDrawnError
from space.reading.fields import field as field_of
from space.reading.grids import grid_cells
from tui.panels.sonar import COURSE, Bounds, ink_of
from tui.widgets.canvas import Canvas, Point


@dataclass(frozen=True)
class Extent:
    """A rectangle of the floor, in metres."""

    left_m: float
    right_m: float
    bottom_m: float
    top_m: float

    def holding(self, *places: Point) -> Extent:
        across, up = [x for x, _y in places], [y for _x, y in places]
        return Extent(
            min([self.left_m, *across]),
            max([self.right_m, *across]),
            min([self.bottom_m, *up]),
            max([self.top_m, *up]),
        )

    def joined(self, other: Extent) -> Extent:
        return self.holding((other.left_m, other.bottom_m), (other.right_m, other.top_m))

    def widened(self, margin_m: float) -> Extent:
        return Extent(
            self.left_m - margin_m, self.right_m + margin_m, self.bottom_m - margin_m, self.top_m + margin_m
        )

    def rounded(self) -> Extent:
        """Round outwards to steps of about a tenth of it: the view must not move with the robot."""
        width_m, height_m = self.right_m - self.left_m, self.top_m - self.bottom_m
        step_m = 10.0 ** math.floor(math.log10(max(width_m, height_m, 1.0)))
        return Extent(
            math.floor(self.left_m / step_m) * step_m,
            math.ceil(self.right_m / step_m) * step_m,
            math.floor(self.bottom_m / step_m) * step_m,
            math.ceil(self.top_m / step_m) * step_m,
        )


@dataclass(frozen=True)
class Viewport:
    """An extent in the middle of a canvas with this many dots."""

    left_m: float
    top_m: float
    """Coordinates of the upper left corner of the first dot."""
    dots_per_m: float
    columns: int
    rows: int
    """In cells."""

    def place(self, x_m: float, y_m: float) -> Point:
        return (x_m - self.left_m) * self.dots_per_m, (self.top_m - y_m) * self.dots_per_m


def fitted(extent: Extent, columns: int, rows: int) -> Viewport:
    width_m = max(1e-6, extent.right_m - extent.left_m)
    height_m = max(1e-6, extent.top_m - extent.bottom_m)
    # Points on the edge are drawn in the outermost dot.
    scale = min((2 * columns - 1) / width_m, (4 * rows - 1) / height_m)
    return Viewport(
        (extent.left_m + extent.right_m) / 2 - columns / scale,
        (extent.bottom_m + extent.top_m) / 2 + 2 * rows / scale,
        scale,
        columns,
        rows,
    )


FARTHEST_M = 1e6
"""A pose farther away than this is not valid."""
OCCUPIED_FROM = 50
"""The threshold of 100, in a nav_msgs/OccupancyGrid."""


@dataclass(frozen=True, eq=False)
class OccupancyGrid:
    """The map of a room; each message creates a new one."""

    cells: NDArray[np.int8]
    """Shape (rows, columns): -1 unknown, 0 free, 100 occupied."""
    cell_m: float
    origin: Pose
    """Position of the corner of the first cell, and the rotation of the rows."""
    frame: str
    extent: Extent | None
    """The known part, None if nothing is known."""

    def centres(
        self, rows: NDArray[np.float64], columns: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        along, up = (columns + 0.5) * self.cell_m, (rows + 0.5) * self.cell_m
        cos, sin = math.cos(self.origin.heading_rad), math.sin(self.origin.heading_rad)
        return self.origin.x_m + cos * along - sin * up, self.origin.y_m + sin * along + cos * up


def pose_in(value: Mapping[str, Any]) -> tuple[Pose, str] | None:
    """Read an Odometry or a PoseStamped: pose and frame; None if the position is not valid."""
    try:
        inner = value["pose"]
        inner = inner.get("pose", inner)
        place, turn = inner["position"], inner["orientation"]
        heading = yaw_from_quaternion(*(float(turn[axis]) for axis in "xyzw"))
        pose = Pose(float(place["x"]), float(place["y"]), heading)
        frame = str(value["header"]["frame_id"])
    except (KeyError, TypeError, ValueError, AttributeError):
        return None
    near = pose.is_finite and max(abs(pose.x_m), abs(pose.y_m)) <= FARTHEST_M
    return (pose, frame) if near else None


def goal_in(value: Mapping[str, Any]) -> Place | None:
    found = pose_in(value)
    if found is None or not found[1]:
        return None
    return Place(found[0].x_m, found[0].y_m)


def occupancy_in(value: Mapping[str, Any]) -> OccupancyGrid | None:
    try:
        found, frame = grid_cells(value), str(field_of(value, "header.frame_id"))
    except NotDrawnError:
        return None
    x_m, y_m, _ = found.origin.translation
    origin = Pose(x_m, y_m, yaw_from_quaternion(*found.origin.rotation))
    occupancy = OccupancyGrid(found.cells, found.cell_m, origin, frame, None)
    return replace(occupancy, extent=_known(occupancy))


def _known(occupancy: OccupancyGrid) -> Extent | None:
    known = occupancy.cells >= 0
    rows, columns = np.flatnonzero(known.any(axis=1)), np.flatnonzero(known.any(axis=0))
    if not rows.size:
        return None
    # Half a cell on each side: the outer edges of the outermost cells.
    x, y = occupancy.centres(
        np.array([rows[0] - 0.5, rows[0] - 0.5, rows[-1] + 0.5, rows[-1] + 0.5]),
        np.array([columns[0] - 0.5, columns[-1] + 0.5, columns[0] - 0.5, columns[-1] + 0.5]),
    )
    return Extent(float(x.min()), float(x.max()), float(y.min()), float(y.max()))


LEAST_M = 0.02
"""Shorter distances are not added."""
TORN_M = 0.6
"""A longer distance was not really driven: the odometry was reset, or nobody was looking."""
MOST = 4000


class DrivenPath:
    """The points of the path in order, in pieces."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        self.pieces: list[list[Point]] = []
        self.length_m = 0.0
        self.bounds: list[Point] = []
        """Opposite corners of the bounding box of the whole path; none at first."""
        self._least_m = LEAST_M

    def add(self, x_m: float, y_m: float) -> None:
        way_m = math.dist(self.pieces[-1][-1], (x_m, y_m)) if self.pieces else math.inf
        if way_m < self._least_m:
            return
        if way_m > max(TORN_M, 2 * self._least_m):
            self.pieces.append([(x_m, y_m)])
        else:
            self.length_m += way_m
            self.pieces[-1].append((x_m, y_m))
        across, up = zip(*self.bounds, (x_m, y_m), strict=True)
        self.bounds = [(min(across), min(up)), (max(across), max(up))]
        if sum(map(len, self.pieces)) > MOST:
            # Without every second point, and the oldest pieces.
            self.pieces = [[*piece[:-1:2], piece[-1]] for piece in self.pieces[-MOST // 4 :]]
            self._least_m *= 2

    def draw(self, canvas: Canvas, view: Viewport) -> None:
        for piece in self.pieces:
            x, y = np.transpose([view.place(*point) for point in piece])
            across, down = np.diff(x), np.diff(y)
            # Of each way as many dots as it takes to have no gap.
            dots = np.maximum(1, np.ceil(np.maximum(abs(across), abs(down)))).astype(int) + 1
            at = np.repeat(np.arange(len(dots)), dots)
            share = (np.arange(len(at)) - np.repeat(np.cumsum(dots) - dots, dots)) / (dots[at] - 1)
            canvas.dots(x[at] + across[at] * share, y[at] + down[at] * share, PATH)


FRONT, REAR = "front", "rear"
APART_M, APART_RAD = 0.05, math.radians(5)
"""Differences from which on the true pose is shown beside the odometry."""
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


@dataclass
class Scene:
    """All that is to be seen."""

    pose: Pose
    frame: str = ""
    truth: Pose | None = None
    """The true pose of a simulated robot, if it is published."""
    goal: Place | None = None
    rays: dict[str, float] = field(default_factory=dict)
    """`FRONT` and `REAR` to metres according to REP-117."""
    bounds: Bounds = COURSE
    """Which of these distances count as near."""
    occupancy: OccupancyGrid | None = None
    path: DrivenPath = field(default_factory=DrivenPath)

    @property
    def truth_apart(self) -> Pose | None:
        """The true pose, if it differs from the pose."""
        if self.truth is None:
            return None
        turned = abs(math.remainder(self.truth.heading_rad - self.pose.heading_rad, math.tau))
        return self.truth if self.pose.distance_to(self.truth) >= APART_M or turned >= APART_RAD else None


def ray_origin(pose: Pose, place: str) -> tuple[Point, float]:
    """Position of a sonar at the bumper in metres, and its direction."""
    offset_m = BODY.length_m - BODY.behind_m if place == FRONT else -BODY.behind_m
    x_m = pose.x_m + offset_m * math.cos(pose.heading_rad)
    y_m = pose.y_m + offset_m * math.sin(pose.heading_rad)
    return (x_m, y_m), pose.heading_rad + (0.0 if place == FRONT else math.pi)


def along(start: Point, heading_rad: float, metres: float) -> Point:
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
    rows, columns = np.nonzero(occupancy.cells >= OCCUPIED_FROM)
    # As many points of each cell as it takes to fill it.
    count = max(1, math.ceil(occupancy.cell_m * view.dots_per_m))
    within = (np.arange(count) + 0.5) / count - 0.5
    x_m, y_m = occupancy.centres(rows[:, None, None] + within[:, None], columns[:, None, None] + within)
    canvas.dots((x_m - view.left_m) * view.dots_per_m, (view.top_m - y_m) * view.dots_per_m, WALL)


def draw_scene(canvas: Canvas, view: Viewport, scene: Scene) -> None:
    draw_grid(canvas, view, grid_step_m(view))
    if scene.occupancy is not None:
        draw_occupancy(canvas, view, scene.occupancy)
    scene.path.draw(canvas, view)
    for place, metres in scene.rays.items():
        _draw_ray(canvas, view, scene.pose, place, metres, ink_of(metres, scene.bounds))
    if scene.goal is not None:
        canvas.sign(view.place(scene.goal.x_m, scene.goal.y_m), GOAL_SIGN, GOAL)
    if scene.truth_apart is not None:
        truth, believed = robot_corners(view, scene.truth_apart), robot_corners(view, scene.pose)
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


def robot_corners(view: Viewport, pose: Pose) -> list[Point]:
    """Nose, left, notch and right of the dart; larger than life if it would be too small."""
    life = _life_dots(view)
    size = max(1.0, _DRAWN_FROM / life)
    return _placed(view, pose, _DART, size, size if life >= _HULL_FROM else size * _WIDER)


def _life_dots(view: Viewport) -> float:
    return BODY.length_m * view.dots_per_m


def _placed(view: Viewport, pose: Pose, shape: tuple[Point, ...], longer: float, wider: float) -> list[Point]:
    """Place a shape, given in halves of the robot's length and width about its centre."""
    middle_m = BODY.length_m / 2 - BODY.behind_m
    cos, sin = math.cos(pose.heading_rad), math.sin(pose.heading_rad)
    corners = []
    for ahead, left in shape:
        x = middle_m + ahead * longer * BODY.length_m / 2
        y = left * wider * BODY.width_m / 2
        corners.append(view.place(pose.x_m + x * cos - y * sin, pose.y_m + x * sin + y * cos))
    return corners
