"""How fast the wheels turn or, without a differential, how fast they would."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robot.joints import REAR_LEFT_WHEEL, REAR_RIGHT_WHEEL
from robot.kinematics import wheel_speeds
from robot.topics import DRIVE, WHEEL_COMMANDS
from text.i18n import N_
from tui.panels.joints import Joints
from tui.panels.other_type import other_type
from tui.panels.panel import Panel, first_published, newest, trouble_of
from tui.panels.wheels.reading import WheelsReading, wheels_in
from tui.panels.wheels.widget import WheelsView

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

    from textual.app import ComposeResult

    from graph.data import GraphUpdate
    from tui.widgets.drawing import Placeholder

DRIVE_TYPE = "ackermann_msgs/msg/AckermannDriveStamped"


class WheelsPanel(Panel):
    """The rear wheels and the steering, from above."""

    title = N_("Wheels")
    least = 4
    weight = 4
    across_below = 80

    def __init__(self) -> None:
        super().__init__()
        self._joints = Joints(WHEEL_COMMANDS, (REAR_LEFT_WHEEL, REAR_RIGHT_WHEEL))
        self._placeholder: Placeholder | None = None
        """Shown instead of the drive commands."""

    def compose(self) -> ComposeResult:
        yield WheelsView()

    def watched(self) -> set[str]:
        """The commands to the wheels, and those to the chassis."""
        return {WHEEL_COMMANDS, DRIVE}

    def show(self, update: GraphUpdate) -> None:
        topic = first_published(update, (WHEEL_COMMANDS, DRIVE))
        self.name_source("" if topic == WHEEL_COMMANDS else topic)
        drawing = self.query_one(WheelsView)
        sample = newest(update, topic)
        if sample is not None:
            wheels = wheels_in(sample.value) if topic == WHEEL_COMMANDS else would_be(sample.value)
            if wheels is not None:
                drawing.show(wheels)
            if topic == WHEEL_COMMANDS:
                self._joints.hear(sample, read=wheels is not None)
            else:
                self._placeholder = other_type(sample, DRIVE_TYPE)
        drawing.show_placeholder(self._joints.placeholder if topic == WHEEL_COMMANDS else self._placeholder)
        drawing.show_trouble(*trouble_of(update, topic))


def would_be(value: Mapping[str, Any]) -> WheelsReading | None:
    """Return what an AckermannDriveStamped would make the wheels do; None for an invalid one."""
    drive = value.get("drive")
    if not drive:
        return None
    speed, steering = float(drive["speed"]), float(drive["steering_angle"])
    try:
        speeds = wheel_speeds(speed, steering)
    except ValueError:
        return None
    return WheelsReading(speeds.left_m_s, speeds.right_m_s, steering)
