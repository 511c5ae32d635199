"""The map: room, robot, its path, what its sonars detect, and where it is driving to."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from text.i18n import _
from tui.panels.map.driven_path import DrivenPath
from tui.panels.map.layers import Layers
from tui.panels.map.legend import column, entries, rows
from tui.panels.map.scene import Scene, along, draw_scene, ray_origin, robot_corners
from tui.panels.map.viewport import Extent, Viewport, fitted
from tui.panels.sonar.words import COURSE
from tui.widgets.drawing import Drawing, Ink, Line

if TYPE_CHECKING:
    from collections.abc import Mapping

    from robot.motion.odometry import Point, Pose
    from tui.panels.map.legend import LegendEntry
    from tui.panels.map.reading import OccupancyGrid
    from tui.panels.sonar.words import Bounds

MOST_ROWS = 5
"""Maximum number of lines of the legend below the map."""
LEGEND = 28
"""Width of the legend beside the map."""
SIDE_WORTH = 0.9
"""A map may be smaller by this factor for a legend beside it, which says more."""
FIELD_FROM = (16, 3)
"""Columns and lines below which the map is not drawn, and there are only words."""
AROUND_M = 1.0
"""Without a room, the width of the floor shown around what is known."""
MARGIN_M = 0.1
FARTHEST_SEEN_M = 100.0
"""No sonar measures farther: a wall beyond it is not included in the map."""
STEADY_M = 0.03
"""A smaller change of a distance is ignored: sonar readings fluctuate."""
APART_M, APART_RAD = 0.05, math.radians(5)
"""Differences from which on the true pose is shown beside the odometry."""


class RoomMap(Drawing):
    """Takes values through `show_...`; `settle` draws them if the change is visible."""

    def __init__(self, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._scene: Scene | None = None
        self._truth: Pose | None = None
        self._goal: Point | None = None
        self._rays: dict[str, float] = {}
        self._bounds = COURSE
        self._occupancy: OccupancyGrid | None = None
        self._frame = ""
        self._seen: Extent | None = None
        """What the rays have reached while there is no room."""
        self._trail = DrivenPath()
        self._layers = Layers()
        self._view: Viewport | None = None
        self._last: object = None

    @property
    def has_value(self) -> bool:
        """Whether the position of the robot is known."""
        return self._scene is not None

    def show_pose(self, pose: Pose, frame: str = "") -> None:
        self._frame = frame
        self._trail.add(pose.x_m, pose.y_m)
        self._scene = Scene(pose)

    def show_truth(self, pose: Pose | None) -> None:
        """Show the true pose of the simulated robot; None if it is not published."""
        self._truth = pose

    def show_goal(self, goal: Point | None) -> None:
        """Show the goal; None if there is none."""
        self._goal = goal

    def show_ray(self, place: str, metres: float | None) -> None:
        """Show the reading of a sonar; None if there is no such sonar."""
        if metres is None:
            self._rays.pop(place, None)
            return
        steady_m = max(STEADY_M, 0.6 / self._view.dots_per_m if self._view else 0.0)
        before = self._rays.get(place)
        if before is None or not abs(metres - before) < steady_m:
            self._rays[place] = metres

    def show_bounds(self, bounds: Bounds) -> None:
        """Show readings below these distances as near."""
        self._bounds = bounds

    def show_occupancy(self, occupancy: OccupancyGrid) -> None:
        self._occupancy = occupancy

    def forget_path(self) -> None:
        self._trail.clear()
        self._seen = None

    def settle(self) -> None:
        """Draw the new values if any cell changes."""
        if self._scene is None:
            return
        self._scene = Scene(
            self._scene.pose, self._truth_apart(self._scene.pose), self._goal, dict(self._rays), self._bounds
        )
        look = self._look(self._scene)
        if look != self._last or not self._lines:
            self._last = look
            self.redraw()

    def draw(self, width: int, height: int) -> list[Line]:
        """Draw the map with its legend beside or below it, whichever leaves the map larger."""
        scene = self._scene
        if scene is None:
            return []
        extent = self._extent(scene)
        below = _legend_rows(extent, width, height)
        under = fitted(extent, width, max(1, height - below))
        self._view = under
        if width < FIELD_FROM[0] or height - below < FIELD_FROM[1]:
            return rows(self._entries(scene, under), width, height)
        if width - LEGEND - 1 >= FIELD_FROM[0]:
            at_side = fitted(extent, width - LEGEND - 1, height)
            if at_side.dots_per_m >= SIDE_WORTH * under.dots_per_m:
                self._view = at_side
                legend = column(self._entries(scene, at_side), LEGEND, height)
                field = self._field(scene, at_side)
                return [[*left, Ink(" "), *right] for left, right in zip(field, legend, strict=True)]
        return [*self._field(scene, under), *rows(self._entries(scene, under), width, below)]

    def _field(self, scene: Scene, view: Viewport) -> list[Line]:
        canvas = self._layers.canvas(view, self._occupancy, self._trail)
        draw_scene(canvas, view, scene)
        return canvas.lines()

    def _entries(self, scene: Scene, view: Viewport) -> list[LegendEntry]:
        remarks = [self.stale_words if self.stale else "", self._other_frame()]
        return entries(scene, view, self._trail.length_m, remarks)

    def _other_frame(self) -> str:
        """Warn about a room in another frame, which may be elsewhere; its transform is unknown."""
        occupancy = self._occupancy
        if occupancy is None or not occupancy.frame or occupancy.frame == self._frame:
            return ""
        return _("map in frame {frame}, not {own}").format(frame=occupancy.frame, own=self._frame)

    def _extent(self, scene: Scene) -> Extent:
        """The room; without one, the floor driven on and measured so far."""
        x, y = scene.pose.x_m, scene.pose.y_m
        here = Extent(x, x, y, y).holding(*self._trail.bounds)
        if scene.goal is not None:
            here = here.holding((scene.goal.x_m, scene.goal.y_m))
        room = self._occupancy.extent if self._occupancy else None
        if room is not None:
            room = room.widened(MARGIN_M)
            return room if room.joined(here) == room else room.joined(here.widened(0.5).rounded())
        seen = [
            along(*ray_origin(scene.pose, place), metres)
            for place, metres in scene.rays.items()
            if abs(metres) <= FARTHEST_SEEN_M
        ]
        self._seen = (self._seen or here).holding(*seen) if seen else self._seen
        known = here if self._seen is None else here.joined(self._seen)
        return known.widened(AROUND_M if self._seen is None else AROUND_M / 2).rounded()

    def _truth_apart(self, pose: Pose) -> Pose | None:
        """The true pose, if it differs from the pose."""
        truth = self._truth
        if truth is None:
            return None
        turned = abs(math.remainder(truth.heading_rad - pose.heading_rad, math.tau))
        return truth if pose.distance_to(truth) >= APART_M or turned >= APART_RAD else None

    def _look(self, scene: Scene) -> object:
        """A value that differs between frames that look different."""
        view = self._view
        if view is None:
            return scene
        shapes = [robot_corners(view, scene.pose)]
        if scene.truth is not None:
            shapes.append(robot_corners(view, scene.truth))
        said: Mapping[int, object] = dict(enumerate(self._entries(scene, view)))
        dots = [[(round(x), round(y)) for x, y in shape] for shape in shapes]
        return (dots, dict(scene.rays), scene.bounds, scene.goal, self._occupancy, said, self._trail.revision)


def _legend_rows(extent: Extent, width: int, height: int) -> int:
    """Lines of the legend below the map: more than a few only if the map does not get smaller."""
    few = 1 if height < 8 else 2 if height < 20 else 3
    largest = fitted(extent, width, max(1, height - few)).dots_per_m
    free = [
        count
        for count in range(few, MOST_ROWS + 1)
        if height - count >= FIELD_FROM[1] and fitted(extent, width, height - count).dots_per_m >= largest
    ]
    return max(free, default=few)
