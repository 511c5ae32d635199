"""Where the robot is, where it has driven, and what is around it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from graph.data import Trouble
from robot.topics import GOAL_POSE, MAP, MOCK_POSE, ODOMETRY, SAFETY_STATE, SONAR_FRONT, SONAR_REAR
from text.i18n import N_, _
from tui.panels.map.reading import goal_in, occupancy_in, pose_in
from tui.panels.map.scene import FRONT, REAR
from tui.panels.map.widget import RoomMap
from tui.panels.other_type import other_type
from tui.panels.panel import Panel, newest, row_of, trouble_of
from tui.panels.sonar.bounds import bounds_of
from tui.panels.sonar.words import COURSE

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.data import GraphUpdate
    from tui.widgets.drawing import Placeholder

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
        self._bounds = COURSE

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
            drawing.show_occupancy(occupancy)
        self._show_goal(update, drawing)
        self._bounds = bounds_of(update, self._bounds)
        drawing.show_bounds(self._bounds)
        for place, topic in SONARS.items():
            self._show_ray(update, drawing, place, topic)
        self._show_pose(update, drawing)
        self._show_truth(update, drawing)
        drawing.settle()
        drawing.show_placeholder(self._placeholder)
        drawing.show_trouble(*self._trouble(update))

    def _choose_pose(self, update: GraphUpdate, drawing: RoomMap) -> None:
        """Use odometry if there is any, otherwise the true pose of a simulated robot."""
        topic = next((one for one in (ODOMETRY, MOCK_POSE) if _is_published(update, one)), "")
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
        if self._pose_topic != ODOMETRY or not _is_published(update, MOCK_POSE):
            drawing.show_truth(None)
            return
        sample = newest(update, MOCK_POSE)
        found = None if sample is None else pose_in(sample.value)
        if found is not None:
            drawing.show_truth(found[0])

    def _show_goal(self, update: GraphUpdate, drawing: RoomMap) -> None:
        sample = newest(update, GOAL_POSE)
        if not _is_published(update, GOAL_POSE):
            drawing.show_goal(None)
        elif sample is not None:
            drawing.show_goal(goal_in(sample.value))

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


def _is_published(update: GraphUpdate, topic: str) -> bool:
    row = row_of(update, topic)
    return row is not None and row.publishers > 0
