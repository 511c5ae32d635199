"""The Map panel: the room from above with robot and path, and a legend of what its signs mean."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from graph.data import GraphUpdate, Trouble
from robot.motion.odometry import Pose
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
    Extent,
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
)
from tui.panels.panel import Panel, is_published, newest, other_type, row_of, trouble_of
from tui.panels.sonar import Bounds, bounds_of, ink_of, remark
from tui.widgets.canvas import Canvas, scale_bar
from tui.widgets.drawing import Drawing, Ink, Line, Placeholder, beside, cells_of, fit
from tui.widgets.pixel_canvas import PixelCanvas

GAP = "  "


class LegendEntry(NamedTuple):
    """One line of the legend; where there is little room, those with a high rank are left out."""

    rank: int
    line: Line


def entries(scene: Scene, view: Viewport, remark: str) -> list[LegendEntry]:
    """All entries in reading order, warnings first."""
    frame = "" if scene.occupancy is None else scene.occupancy.frame
    if frame and frame != scene.frame:
        # The room may be elsewhere: the transform is unknown.
        frame = _("map in frame {frame}, not {own}").format(frame=frame, own=scene.frame)
    else:
        frame = ""
    said = [LegendEntry(0, [Ink(plain(words, 200), "alert")]) for words in (remark, frame) if words]
    said += _robot(scene.pose)
    if scene.path.length_m >= 0.05:
        words = _("path {metres} m").format(metres=figure(scene.path.length_m, 1))
        said.append(LegendEntry(7, [Ink("─ ", PATH), Ink(words)]))
    if scene.goal is not None:
        metres = scene.pose.distance_to(scene.goal)
        words = _("goal {metres} m away").format(metres=figure(metres, 1))
        said.append(LegendEntry(3, [Ink(f"{GOAL_SIGN} ", GOAL), Ink(words)]))
    said += [LegendEntry(4, _ray(place, metres, scene.bounds)) for place, metres in scene.rays.items()]
    if scene.truth_apart is not None:
        metres = scene.pose.distance_to(scene.truth_apart)
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
SIDE_WORTH = 0.9
"""A map may be smaller by this factor for a legend beside it, which says more."""
FIELD_FROM = (16, 3)
"""Columns and lines below which the map is not drawn, and there are only words."""
AROUND_M = 1.0
"""Without a room, the width of the floor shown around what is known."""
MARGIN_M = 0.1
FARTHEST_SEEN_M = 100.0
"""No sonar measures farther: a wall beyond it is not included in the map."""


class RoomMap(Drawing):
    """Shows a `Scene`, once it has a path: the robot's first pose begins that."""

    def __init__(self) -> None:
        super().__init__()
        self.scene = Scene(Pose(0.0, 0.0, 0.0))
        self._seen: Extent | None = None
        """What the rays have reached while there is no room."""
        self._in_pixels = PixelCanvas(self)

    @property
    def has_value(self) -> bool:
        return bool(self.scene.path.pieces)

    def forget_path(self) -> None:
        self.scene.path.clear()
        self._seen = None

    def draw(self, width: int, height: int) -> list[Line]:
        """Draw the map with its legend beside or below it, whichever leaves the map larger."""
        extent = self._extent(self.scene)
        below = _legend_rows(extent, width, height)
        view = fitted(extent, width, max(1, height - below))
        if width - LEGEND - 1 >= FIELD_FROM[0]:
            at_side = fitted(extent, width - LEGEND - 1, height)
            if at_side.dots_per_m >= SIDE_WORTH * view.dots_per_m:
                legend = column(self._entries(at_side), LEGEND, height)
                return [[*left, Ink(" "), *right] for left, right in zip(self._field(at_side), legend, strict=True)]
        if width < FIELD_FROM[0] or height - below < FIELD_FROM[1]:
            return rows(self._entries(view), width, height)
        return [*self._field(view), *rows(self._entries(view), width, below)]

    def _field(self, view: Viewport) -> list[Line]:
        """The floor, in pixels where there are some, else in braille."""
        extent = self._extent(self.scene)
        fine = self._in_pixels.lines(
            view.columns, view.rows, lambda columns, rows: self._canvas(fitted(extent, columns, rows))
        )
        return self._canvas(view).lines() if fine is None else fine

    def _canvas(self, view: Viewport) -> Canvas:
        canvas = Canvas(view.columns, view.rows)
        draw_scene(canvas, view, self.scene)
        return canvas

    def _entries(self, view: Viewport) -> list[LegendEntry]:
        return entries(self.scene, view, self.stale_words if self.stale else "")

    def _extent(self, scene: Scene) -> Extent:
        """The room; without one, the floor driven on and measured so far."""
        x, y = scene.pose.x_m, scene.pose.y_m
        here = Extent(x, x, y, y).holding(*scene.path.bounds)
        if scene.goal is not None:
            here = here.holding((scene.goal.x_m, scene.goal.y_m))
        room = scene.occupancy.extent if scene.occupancy else None
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

    view = RoomMap
    title = N_("Map")
    least = 6
    weight = 6
    across_below = 96

    def __init__(self) -> None:
        super().__init__()
        self._pose_topic = ""
        self._heard_s = -math.inf
        self._placeholder: Placeholder | None = None

    def watched(self) -> set[str]:
        """The topics of the map; the path is built from the poses received."""
        return {ODOMETRY, MOCK_POSE, MAP, GOAL_POSE, SAFETY_STATE, *SONARS.values()}

    def kept(self) -> set[str]:
        """The pose, so that the path continues."""
        return {ODOMETRY, MOCK_POSE}

    def keep(self, update: GraphUpdate) -> None:
        """Continue the path without drawing it; by odometry, otherwise by the true pose of a simulated robot."""
        drawing = self.query_one(RoomMap)
        topic = next((one for one in (ODOMETRY, MOCK_POSE) if is_published(update, one)), "")
        if topic and self._pose_topic not in {topic, ODOMETRY}:
            if self._pose_topic:
                drawing.forget_path()
            self._pose_topic = topic
            self._placeholder = None
            self.name_source("" if topic == ODOMETRY else topic)
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
            drawing.scene.pose, drawing.scene.frame = found
            drawing.scene.path.add(found[0].x_m, found[0].y_m)

    def show(self, update: GraphUpdate) -> None:
        self.keep(update)
        drawing = self.query_one(RoomMap)
        scene, room, goal, truth = drawing.scene, *(newest(update, one) for one in (MAP, GOAL_POSE, MOCK_POSE))
        scene.occupancy = (None if room is None else occupancy_in(room.value)) or scene.occupancy
        if not is_published(update, GOAL_POSE):
            scene.goal = None
        elif goal is not None:
            scene.goal = goal_in(goal.value)
        if self._pose_topic != ODOMETRY or not is_published(update, MOCK_POSE):
            scene.truth = None
        elif truth is not None and (found := pose_in(truth.value)) is not None:
            scene.truth = found[0]
        scene.bounds = bounds_of(update, scene.bounds)
        for place, topic in SONARS.items():
            row, sample = row_of(update, topic), newest(update, topic)
            metres = None if sample is None else sample.value.get("data")
            if row is None or not row.publishers:
                scene.rays.pop(place, None)
            elif row.trouble is not None:
                # The last reading of a sonar that has gone silent is no longer valid.
                scene.rays[place] = math.nan
            elif isinstance(metres, (int, float)):
                scene.rays[place] = float(metres)
        drawing.redraw()
        drawing.show_placeholder(self._placeholder)
        drawing.show_trouble(*self._trouble(update))

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
