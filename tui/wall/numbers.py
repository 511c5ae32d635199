"""The numbers of the wall: distances, speed, battery, with unit and meaning, as large as there is room."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from textual.content import Content
from textual.widget import Widget

from graph.data import GraphUpdate
from robot.topics import BATTERY, ODOMETRY, SONAR_FRONT, SONAR_REAR, WHEEL_COMMANDS
from text.figures import figure, whole
from text.i18n import N_, _
from text.plain import plain
from tui.panels.panel import is_published, newest, trouble_of
from tui.panels.sonar import Bounds, Zone, number, remark, zone_of
from tui.panels.wheels import wheels_in
from tui.widgets.trouble import no_data_words, trouble_words

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
            if is_published(update, topic):
                metres = _number(self._values.get(topic, {}).get("data"))
                yield _current(update, topic, _distance(_(label), metres, bounds))
        of_speed = next((one for one in (ODOMETRY, WHEEL_COMMANDS) if is_published(update, one)), "")
        if of_speed:
            speed = speed_in(of_speed, self._values.get(of_speed, {}))
            yield _current(update, of_speed, _speed(speed))
        if is_published(update, BATTERY):
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
    trouble, _detail, age_s = trouble_of(update, topic)
    if trouble is None:
        return shown
    why = trouble_words(trouble) if age_s is None else no_data_words(age_s)
    return shown._replace(note=why, look="muted")


def _number(value: object) -> float:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if is_number else math.nan  # type: ignore[arg-type]


LOOKS = {
    "": ("", ""),
    "good": ("$text-success", "$text-success"),
    "warn": ("$text-warning", "$text-warning"),
    "bad": ("$text-error", "$text-error"),
    "muted": ("$foreground 40%", "$text-warning"),
}
"""The colours of digits and note."""
WIDEST = "-0.00"
"""What has room always, so that no sign changes the size."""
LONGEST = 60
_LETTERS = {
    "S": ("▟███▙", "█▖   ", "▝███▖", "   ▝█", "▜███▛"),
    "T": ("█████", "  █  ", "  █  ", "  █  ", "  █  "),
    "O": ("▟███▙", "█   █", "█   █", "█   █", "▜███▛"),
    "P": ("████▙", "█   █", "████▛", "█    ", "█    "),
    "С": ("▟███▙", "█    ", "█    ", "█    ", "▜███▛"),
    "Т": ("█████", "  █  ", "  █  ", "  █  ", "  █  "),
    "О": ("▟███▙", "█   █", "█   █", "█   █", "▜███▛"),
    "П": ("█████", "█   █", "█   █", "█   █", "█   █"),
}
"""Letters five lines high: no seven segments make these."""


class BigNumber(Widget):
    """Label, digits as large as there is room, and a word below them."""

    DEFAULT_CSS = """
    BigNumber {
        width: 1fr; height: 1fr; padding: 0 1; content-align: left middle;
        text-wrap: nowrap; text-overflow: ellipsis;
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self.shown: WallNumber | None = None

    def show(self, number: WallNumber) -> None:
        if number != self.shown:
            self.shown = number
            self.refresh()

    def _room(self) -> tuple[int, int]:
        """Return the columns and rows for digits, those of the smallest number on the wall.

        What is left of a room divided by three or four would make some a little larger.
        """
        beside = [one.size for one in self.siblings if isinstance(one, BigNumber) and one.display]
        sizes = [self.size, *(size for size in beside if size.area)]
        return min(size.width for size in sizes), min(size.height for size in sizes) - 2

    def render(self) -> Content:
        if self.shown is None:
            return Content("")
        value, (of_value, of_note) = plain(self.shown.value, LONGEST), LOOKS[self.shown.look]
        size = size_for((value, WIDEST), *self._room())
        lines = [value] if size is None else digit_lines(value, size)
        return Content("\n").join(
            [
                Content.styled(plain(self.shown.label, LONGEST), "$foreground 60%"),
                *(Content.styled(line, f"bold {of_value}") for line in lines),
                Content.styled(plain(self.shown.note, LONGEST), f"bold {of_note}"),
            ]
        )


def big_word(word: str) -> str:
    """Return a word in letters five lines high; one that lacks a letter as it is."""
    if not all(letter in _LETTERS for letter in word):
        return word
    return "\n".join("  ".join(_LETTERS[letter][row] for letter in word) for row in range(5))


_SEGMENTS = {
    "0": "abcdef",
    "1": "bc",
    "2": "abged",
    "3": "abgcd",
    "4": "fgbc",
    "5": "afgcd",
    "6": "afgedc",
    "7": "abc",
    "8": "abcdefg",
    "9": "abcdfg",
    "e": "adefg",
    "-": "g",
    ".": "",
    ",": "",
    "∞": "",
}
"""Segments by their usual letters: a to f clockwise from the top, g in the middle."""
LEAST_HIGH = 6
WIDTH = 0.55
"""Of a digit, as a share of its height."""
STROKE = 6
"""How many strokes wide a digit is high."""
_HALVES = {(0, 0): " ", (1, 0): "▀", (0, 1): "▄", (1, 1): "█"}


class DigitSize(NamedTuple):
    """The size of a digit."""

    high: int
    wide: int
    thick: int


def size_for(texts: tuple[str, ...], columns: int, rows: int) -> DigitSize | None:
    """Return the largest size at which each text fits; None if there is none, or no such sign."""
    if not all(sign in _SEGMENTS for text in texts for sign in text):
        return None
    for high in range(2 * rows, LEAST_HIGH - 1, -1):
        size = DigitSize(high, round(WIDTH * high), max(1, round(high / STROKE)))
        if all(_width(text, size) <= columns for text in texts):
            return size
    return None


def digit_lines(text: str, size: DigitSize) -> list[str]:
    pixels = [[0] * _width(text, size) for _row in range(size.high + size.high % 2)]
    x = 0
    for sign in text:
        for left, top, wide, high in _bars(sign, size):
            for row in pixels[top : top + high]:
                row[x + left : x + left + wide] = [1] * wide
        x += _sign_width(sign, size) + size.thick
    return [
        "".join(_HALVES[both] for both in zip(upper, lower, strict=True))
        for upper, lower in zip(pixels[::2], pixels[1::2], strict=True)
    ]


def _width(text: str, size: DigitSize) -> int:
    return sum(_sign_width(sign, size) + size.thick for sign in text) - size.thick if text else 0


def _sign_width(sign: str, size: DigitSize) -> int:
    if sign in ".,":
        return size.thick
    if sign == "∞":
        return 2 * size.wide - size.thick
    return (2 * size.wide + 1) // 3 if sign == "-" else size.wide


def _bars(sign: str, size: DigitSize) -> list[tuple[int, int, int, int]]:
    """Return the bars of a sign: left, top, width, height."""
    high, wide, thick = size
    middle, right, bottom = (high - thick) // 2, wide - thick, high - thick
    if sign == ".":
        return [(0, bottom, thick, thick)]
    if sign == ",":
        return [(0, bottom - thick, thick, 2 * thick)]
    if sign == "∞":
        top, low = high // 4, high - high // 4 - thick
        across = [(0, y, 2 * wide - thick, thick) for y in (top, low)]
        return across + [(x, top, thick, low - top) for x in (0, right, 2 * right)]
    bars = {
        "a": (0, 0, wide, thick),
        "b": (right, 0, thick, middle + thick),
        "c": (right, middle, thick, high - middle),
        "d": (0, bottom, wide, thick),
        "e": (0, middle, thick, high - middle),
        "f": (0, 0, thick, middle + thick),
        "g": (0, middle, _sign_width(sign, size), thick),
    }
    return [bars[segment] for segment in _SEGMENTS[sign]]
