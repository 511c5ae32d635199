"""The Map panel: the room from above with robot and path, and a legend of what its signs mean."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from graph.data import Trouble
from robot.topics import GOAL_POSE, MAP, MOCK_POSE, ODOMETRY, SONAR_FRONT, SONAR_REAR
from safety.topics import SAFETY_STATE
from text.figures import figure
from text.i18n import N_, _, decimal
from text.plain import plain
from tui.panels.map_scene import (
    BLIND_SIGN,
    FREE_SIGN,
    FRONT,
    GOAL,
    GOAL_SIGN,
    HIT_SIGN,
    PATH,
    REAR,
    ROBOT,
    TRUTH,
    DrivenPath,
    Extent,
    Layers,
    Scene,
    Viewport,
    along,
    draw_scene,
    fitted,
    goal_in,
    grid_step_m,
    occupancy_in,
    pose_in,
    ray_origin,
    robot_corners,
)
from tui.panels.panel import Panel, is_published, newest, other_type, row_of, trouble_of
from tui.panels.sonar import COURSE, bounds_of, ink_of, remark
from tui.widgets.drawing import Drawing, Ink, Line, beside, cells_of, fit
from tui.widgets.scale_bar import scale_bar

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from textual.app import ComposeResult

    from graph.data import GraphUpdate
    from robot.motion.odometry import Point, Pose
    from tui.panels.map_scene import OccupancyGrid
    from tui.panels.sonar import Bounds
    from tui.widgets.drawing import Placeholder

GAP = "  "


class LegendEntry(NamedTuple):
    """One line of the legend; where there is little room, those with a high rank are left out."""

    rank: int
    line: Line


def entries(scene: Scene, view: Viewport, driven_m: float, remarks: Sequence[str]) -> list[LegendEntry]:
    """All entries in reading order; `remarks` are warnings."""
    said = [LegendEntry(0, [Ink(plain(words, 200), "alert")]) for words in remarks if words]
    said += _robot(scene.pose)
    if driven_m >= 0.05:
        words = _("path {metres} m").format(metres=figure(driven_m, 1))
        said.append(LegendEntry(7, [Ink("─ ", PATH), Ink(words)]))
    if scene.goal is not None:
        metres = scene.pose.distance_to(scene.goal)
        words = _("goal {metres} m away").format(metres=figure(metres, 1))
        said.append(LegendEntry(3, [Ink(f"{GOAL_SIGN} ", GOAL), Ink(words)]))
    said += [LegendEntry(4, _ray(place, metres, scene.bounds)) for place, metres in scene.rays.items()]
    if scene.truth is not None:
        metres = scene.pose.distance_to(scene.truth)
        words = _("true pose, {metres} m off").format(metres=decimal(f"{metres:.2f}"))
        said.append(LegendEntry(5, [Ink("◇ ", TRUTH), Ink(words)]))
    said.append(LegendEntry(2, scale_bar(view.dots_per_m)))
    said.append(LegendEntry(8, [Ink(_("x → right, y ↑ up"), "muted")]))
    words = _("· every {metres} m").format(metres=decimal(f"{grid_step_m(view):g}"))
    said.append(LegendEntry(9, [Ink(words, "muted")]))
    return said


def _robot(pose: Pose) -> list[LegendEntry]:
    place = _("x {x}  y {y} m").format(x=decimal(f"{pose.x_m:.2f}"), y=decimal(f"{pose.y_m:.2f}"))
    degrees = round(math.degrees(pose.heading_rad))
    heading = _("heading {degrees}°").format(degrees=degrees)
    return [LegendEntry(1, [Ink("▲ ", ROBOT), Ink(place, "strong")]), LegendEntry(6, [Ink("  "), Ink(heading)])]


def _ray(place: str, metres: float, bounds: Bounds) -> Line:
    name = _("front") if place == FRONT else _("rear")
    words = remark(metres) or _("{metres} m").format(metres=figure(metres, 1))
    sign = BLIND_SIGN if math.isnan(metres) else FREE_SIGN if metres == math.inf else HIT_SIGN
    return [Ink(f"{sign} ", ink_of(metres, bounds)), Ink(f"{name} {words}")]


def column(said: Sequence[LegendEntry], width: int, height: int) -> list[Line]:
    """The entries below each other in exactly this space; the least important are left out."""
    lines = [beside(entry.line, [], width) for entry in _foremost(said, height)]
    return [*lines, *([[Ink(" " * width)]] * (height - len(lines)))]


def rows(said: Sequence[LegendEntry], width: int, height: int) -> list[Line]:
    """The entries side by side in at most `height` lines; the least important are left out."""
    for count in range(len(said), 0, -1):
        lines = _packed(_foremost(said, count), width)
        if len(lines) <= height:
            return lines
    line = min(said, key=lambda entry: entry.rank).line if said else []
    return [beside(line, [], width)] if line else []


def _foremost(said: Sequence[LegendEntry], count: int) -> list[LegendEntry]:
    """The `count` most important entries, in reading order."""
    kept = sorted(range(len(said)), key=lambda at: (said[at].rank, at))[:count]
    return [said[at] for at in sorted(kept)]


def _packed(said: Sequence[LegendEntry], width: int) -> list[Line]:
    lines: list[Line] = []
    for entry in said:
        line = [Ink(entry.line[0].text.lstrip(), entry.line[0].look), *entry.line[1:]]
        if lines and cells_of(lines[-1]) + len(GAP) + cells_of(line) <= width:
            lines[-1] = [*lines[-1], Ink(GAP), *line]
        elif cells_of(line) <= width:
            lines.append(line)
        else:
            lines.append([Ink(fit("".join(ink.text for ink in line), width), line[-1].look)])
    return lines


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
    """Takes values by its fields and `show_...`; `settle` draws them if the change is visible."""

    def __init__(self, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._scene: Scene | None = None
        self.truth: Pose | None = None
        """The true pose of the simulated robot; None if it is not published."""
        self.goal: Point | None = None
        self._rays: dict[str, float] = {}
        self.bounds = COURSE
        """Readings below these distances are near."""
        self.occupancy: OccupancyGrid | None = None
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

    def show_ray(self, place: str, metres: float | None) -> None:
        """Show the reading of a sonar; None if there is no such sonar."""
        if metres is None:
            self._rays.pop(place, None)
            return
        steady_m = max(STEADY_M, 0.6 / self._view.dots_per_m if self._view else 0.0)
        before = self._rays.get(place)
        if before is None or not abs(metres - before) < steady_m:
            self._rays[place] = metres

    def forget_path(self) -> None:
        self._trail.clear()
        self._seen = None

    def settle(self) -> None:
        """Draw the new values if any cell changes."""
        if self._scene is None:
            return
        self._scene = Scene(
            self._scene.pose, self._truth_apart(self._scene.pose), self.goal, dict(self._rays), self.bounds
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
        canvas = self._layers.canvas(view, self.occupancy, self._trail)
        draw_scene(canvas, view, scene)
        return canvas.lines()

    def _entries(self, scene: Scene, view: Viewport) -> list[LegendEntry]:
        remarks = [self.stale_words if self.stale else "", self._other_frame()]
        return entries(scene, view, self._trail.length_m, remarks)

    def _other_frame(self) -> str:
        """Warn about a room in another frame, which may be elsewhere; its transform is unknown."""
        occupancy = self.occupancy
        if occupancy is None or not occupancy.frame or occupancy.frame == self._frame:
            return ""
        return _("map in frame {frame}, not {own}").format(frame=occupancy.frame, own=self._frame)

    def _extent(self, scene: Scene) -> Extent:
        """The room; without one, the floor driven on and measured so far."""
        x, y = scene.pose.x_m, scene.pose.y_m
        here = Extent(x, x, y, y).holding(*self._trail.bounds)
        if scene.goal is not None:
            here = here.holding((scene.goal.x_m, scene.goal.y_m))
        room = self.occupancy.extent if self.occupancy else None
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
        truth = self.truth
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
        return (dots, dict(scene.rays), scene.bounds, scene.goal, self.occupancy, said, self._trail.revision)


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


TYPES = {ODOMETRY: "nav_msgs/msg/Odometry", MOCK_POSE: "geometry_msgs/msg/PoseStamped"}
SONARS = {FRONT: SONAR_FRONT, REAR: SONAR_REAR}


class MapPanel(Panel):
    """The room from above."""

    title = N_("Map")
    least = 6
    weight = 6
    across_below = 96

    def __init__(self) -> None:
        super().__init__()
        self._pose_topic = ""
        """The topic of the pose; empty until there is one."""
        self._heard_s = -math.inf
        self._placeholder: Placeholder | None = None

    def compose(self) -> ComposeResult:
        yield RoomMap()

    def watched(self) -> set[str]:
        """The topics of the map; the path is built from the poses received."""
        return {ODOMETRY, MOCK_POSE, MAP, GOAL_POSE, SAFETY_STATE, *SONARS.values()}

    def kept(self) -> set[str]:
        """The pose, so that the path continues."""
        return {ODOMETRY, MOCK_POSE}

    def keep(self, update: GraphUpdate) -> None:
        """Continue the path without drawing it."""
        drawing = self.query_one(RoomMap)
        self._choose_pose(update, drawing)
        self._show_pose(update, drawing)

    def show(self, update: GraphUpdate) -> None:
        drawing = self.query_one(RoomMap)
        self._choose_pose(update, drawing)
        room = newest(update, MAP)
        occupancy = None if room is None else occupancy_in(room.value)
        if occupancy is not None:
            drawing.occupancy = occupancy
        self._show_goal(update, drawing)
        drawing.bounds = bounds_of(update, drawing.bounds)
        for place, topic in SONARS.items():
            self._show_ray(update, drawing, place, topic)
        self._show_pose(update, drawing)
        self._show_truth(update, drawing)
        drawing.settle()
        drawing.show_placeholder(self._placeholder)
        drawing.show_trouble(*self._trouble(update))

    def _choose_pose(self, update: GraphUpdate, drawing: RoomMap) -> None:
        """Use odometry if there is any, otherwise the true pose of a simulated robot."""
        topic = next((one for one in (ODOMETRY, MOCK_POSE) if is_published(update, one)), "")
        if not topic or self._pose_topic in {topic, ODOMETRY}:
            return
        if self._pose_topic:
            drawing.forget_path()
        self._pose_topic = topic
        self._placeholder = None
        self.name_source("" if topic == ODOMETRY else topic)

    def _show_pose(self, update: GraphUpdate, drawing: RoomMap) -> None:
        for sample in update.samples.get(self._pose_topic, ()):
            found = pose_in(sample.value)
            if found is None:
                self._placeholder = other_type(sample, TYPES[self._pose_topic])
                continue
            self._placeholder = None
            if sample.received_s < self._heard_s:
                # Time went back: somebody jumped back in a recording.
                drawing.forget_path()
            self._heard_s = sample.received_s
            drawing.show_pose(*found)

    def _show_truth(self, update: GraphUpdate, drawing: RoomMap) -> None:
        if self._pose_topic != ODOMETRY or not is_published(update, MOCK_POSE):
            drawing.truth = None
            return
        sample = newest(update, MOCK_POSE)
        found = None if sample is None else pose_in(sample.value)
        if found is not None:
            drawing.truth = found[0]

    def _show_goal(self, update: GraphUpdate, drawing: RoomMap) -> None:
        sample = newest(update, GOAL_POSE)
        if not is_published(update, GOAL_POSE):
            drawing.goal = None
        elif sample is not None:
            drawing.goal = goal_in(sample.value)

    def _show_ray(self, update: GraphUpdate, drawing: RoomMap, place: str, topic: str) -> None:
        row = row_of(update, topic)
        if row is None or not row.publishers:
            drawing.show_ray(place, None)
        elif row.trouble is not None:
            # The last reading of a sonar that has gone silent is no longer valid.
            drawing.show_ray(place, math.nan)
        else:
            sample = newest(update, topic)
            metres = None if sample is None else sample.value.get("data")
            if isinstance(metres, (int, float)):
                drawing.show_ray(place, float(metres))

    def _trouble(self, update: GraphUpdate) -> tuple[Trouble | None, str, float | None]:
        topic = self._pose_topic or ODOMETRY
        trouble, detail, age_s = trouble_of(update, topic)
        if trouble is Trouble.NO_PUBLISHER:
            hint = _("Start chassis; drive_to_point brings a simulated base.")
            detail = f"{detail}. {hint}"
        elif trouble is Trouble.QUIET:
            hint = _("Its log says what it is waiting for.")
            detail = f"{detail}. {hint}"
        # The age is shown in whole seconds, and not redrawn more often.
        return trouble, detail, None if age_s is None else age_s // 1
