"""The distance to the nearest obstacle, ahead and behind."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robot.topics import SAFETY_STATE, SONAR_FRONT, SONAR_REAR
from text.i18n import N_
from tui.panels.other_type import other_type
from tui.panels.panel import ALWAYS, Panel, newest, row_of, trouble_of
from tui.panels.sonar.bounds import bounds_of
from tui.panels.sonar.widget import SonarView
from tui.panels.sonar.words import COURSE

if TYPE_CHECKING:
    from textual.app import ComposeResult

    from graph.data import GraphUpdate

TYPE = "std_msgs/msg/Float32"
TOPICS = {"front": SONAR_FRONT, "rear": SONAR_REAR}


class SonarPanel(Panel):
    """The front sonar, and the rear one if somebody publishes it."""

    title = N_("Sonar")
    least = 2
    weight = 2
    across_below = ALWAYS

    def __init__(self) -> None:
        super().__init__()
        self._bounds = COURSE

    def compose(self) -> ComposeResult:
        yield SonarView()

    def watched(self) -> set[str]:
        return {*TOPICS.values(), SAFETY_STATE}

    def kept(self) -> set[str]:
        """Both sonars, so that the trend has no gap."""
        return set(TOPICS.values())

    def show(self, update: GraphUpdate) -> None:
        """Show every reading, for the trend."""
        gauges = self.query_one(SonarView)
        rear = row_of(update, TOPICS["rear"])
        if rear is not None and rear.publishers:
            # One that has gone silent stays, with a remark.
            gauges.set_both(True)
        self._bounds = bounds_of(update, self._bounds)
        gauges.set_bounds(self._bounds)
        for place, topic in TOPICS.items():
            for sample in update.samples.get(topic, ()):
                metres = sample.value.get("data")
                if isinstance(metres, (int, float)):
                    gauges.show(place, float(metres), sample.received_s)
            if topic in update.samples:
                gauges.show_placeholder(place, other_type(newest(update, topic), TYPE))
            gauges.show_trouble(place, *trouble_of(update, topic))
