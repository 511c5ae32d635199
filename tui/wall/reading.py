"""What the wall says in numbers: distances, speed, battery; each with its unit and its meaning."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

from robot.topics import BATTERY, ODOMETRY, SONAR_FRONT, SONAR_REAR, WHEEL_COMMANDS
from text.figures import figure, whole
from text.i18n import N_, _
from tui.panels.panel import newest, row_of, trouble_of
from tui.panels.sonar import Bounds, Zone, number, remark, zone_of
from tui.panels.wheels import wheels_in
from tui.widgets.trouble import no_data_words, trouble_words

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from graph.data import GraphUpdate

MOVES_M_S = 0.005
"""Below this speed the robot stands."""
LOW_BATTERY = 0.2
NOTHING = "---"


class WallNumber(NamedTuple):
    """One number as it is shown."""

    label: str
    """With the unit: `front, m`."""
    value: str
    """Digits and signs."""
    note: str = ""
    """A word on what it means, or why it is not current."""
    look: str = ""
    """`good`, `warn`, `bad`, `muted` or none."""


class WallReader:
    """Keeps the newest value of each topic, since an update only has those that are new."""

    def __init__(self) -> None:
        self._values: dict[str, Mapping[str, Any]] = {}

    def numbers(self, update: GraphUpdate, bounds: Bounds) -> list[WallNumber]:
        """Return the numbers that somebody publishes, in a fixed order."""
        for topic in (SONAR_FRONT, SONAR_REAR, ODOMETRY, WHEEL_COMMANDS, BATTERY):
            sample = newest(update, topic)
            if sample is not None:
                self._values[topic] = sample.value
        return list(self._all(update, bounds))

    def _all(self, update: GraphUpdate, bounds: Bounds) -> Iterator[WallNumber]:
        for topic, label in ((SONAR_FRONT, N_("ahead, m")), (SONAR_REAR, N_("behind, m"))):
            if _is_published(update, topic):
                metres = _number(self._values.get(topic, {}).get("data"))
                yield _current(update, topic, _distance(_(label), metres, bounds))
        of_speed = next((one for one in (ODOMETRY, WHEEL_COMMANDS) if _is_published(update, one)), "")
        if of_speed:
            speed = speed_in(of_speed, self._values.get(of_speed, {}))
            yield _current(update, of_speed, _speed(speed))
        if _is_published(update, BATTERY):
            yield _current(update, BATTERY, _battery(self._values.get(BATTERY, {})))


def speed_in(topic: str, value: Mapping[str, Any]) -> float:
    """Return the speed in m/s that an Odometry or a JointState of the wheels tells; else nan."""
    if topic == WHEEL_COMMANDS:
        wheels = wheels_in(value)
        return math.nan if wheels is None else (wheels.left_m_s + wheels.right_m_s) / 2
    try:
        return _number(value["twist"]["twist"]["linear"]["x"])
    except (KeyError, TypeError):
        return math.nan


def _distance(label: str, metres: float, bounds: Bounds) -> WallNumber:
    zone = zone_of(metres, bounds)
    look = "bad" if zone in (Zone.STOP, Zone.BLIND) else zone.look
    return WallNumber(label, number(metres), remark(metres) or zone.word, look)


def _speed(speed: float) -> WallNumber:
    words = _("stands") if abs(speed) < MOVES_M_S else _("ahead") if speed > 0 else _("back")
    return WallNumber(_("speed, m/s"), figure(speed), "" if math.isnan(speed) else words)


def _battery(value: Mapping[str, Any]) -> WallNumber:
    """Read a sensor_msgs/BatteryState: the charge if it is known, else the voltage."""
    share, volts = _number(value.get("percentage")), _number(value.get("voltage"))
    if 0.0 <= share <= 1.0:
        look = "bad" if share < LOW_BATTERY else "good"
        words = "" if math.isnan(volts) else _("{volts} V").format(volts=figure(volts, 1))
        return WallNumber(_("battery, %"), whole(100 * share), words, look)
    return WallNumber(_("battery, V"), figure(volts, 1))


def _current(update: GraphUpdate, topic: str, shown: WallNumber) -> WallNumber:
    """Return the number, greyed out with the reason if it is not current."""
    trouble, _detail, age_s = trouble_of(update, topic)
    if trouble is None:
        return shown
    why = trouble_words(trouble) if age_s is None else no_data_words(age_s)
    return shown._replace(note=why, look="muted")


def _is_published(update: GraphUpdate, topic: str) -> bool:
    row = row_of(update, topic)
    return row is not None and row.publishers > 0


def _number(value: object) -> float:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if is_number else math.nan  # type: ignore[arg-type]
