"""The Sonar panel: distances, what they mean (REP-117), and their trend; bounds, bar and words also for others."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable
from enum import Enum
from typing import NamedTuple

from textual.app import ComposeResult
from textual.renderables.digits import DIGITS, DIGITS3X3_BOLD

from graph.data import GraphUpdate
from robot.topics import SONAR_FRONT, SONAR_REAR
from safety.gate_report import Gate, gate_in
from safety.topics import SAFETY_STATE
from text.figures import figure, whole
from text.i18n import N_, _, decimal
from tui.panels.panel import ALWAYS, Panel, is_published, newest, other_type, row_of, trouble_of
from tui.widgets.drawing import Drawing, Ink, Line, beside, cells_of

FREE_FROM_M = 1.0
"""ai_brain drives ahead from this distance on."""
RANGE_M = 3.0
"""The distance at the right end of the bar."""


class Bounds(NamedTuple):
    """Which distances count as near, in metres; those of the course until the gate reports any."""

    stop_below_m: float = 0.5
    """safety_stop holds the wheels below this distance."""
    free_from_m: float = FREE_FROM_M
    """From this distance on nothing slows the robot down."""


COURSE = Bounds()


class Zone(Enum):
    """The word and the look for a distance."""

    FREE = (N_("FREE"), "good")
    CLOSE = (N_("CLOSE"), "warn")
    STOP = (N_("STOP"), "stop")
    BLIND = (N_("BLIND"), "stop")

    @property
    def word(self) -> str:
        return _(self.value[0])

    @property
    def look(self) -> str:
        return self.value[1]


def zone_of(metres: float, bounds: Bounds = COURSE) -> Zone:
    """The zone of a distance in metres; +inf is free, -inf too close, nan blind."""
    if math.isnan(metres):
        return Zone.BLIND
    if metres < bounds.stop_below_m:
        return Zone.STOP
    return Zone.CLOSE if metres < bounds.free_from_m else Zone.FREE


def number(metres: float) -> str:
    if math.isnan(metres):
        return "---"
    if math.isinf(metres):
        return "∞" if metres > 0 else "0"
    return figure(metres)


def remark(metres: float) -> str:
    """The meaning of a value that is not a distance; empty for a distance."""
    if math.isnan(metres):
        return _("no valid reading")
    if math.isinf(metres):
        return _("nothing in range") if metres > 0 else _("too close to measure")
    return _("impossible: below zero") if metres < 0 else ""


EIGHTHS = " ▏▎▍▌▋▊▉█"
HEIGHTS = " ▁▂▃▄▅▆▇█"
_INK = {Zone.FREE: "good", Zone.CLOSE: "warn", Zone.STOP: "bad", Zone.BLIND: "bad"}


def ink_of(metres: float, bounds: Bounds) -> str:
    return _INK[zone_of(metres, bounds)]


def bar(metres: float, width: int, bounds: Bounds) -> Line:
    """A bar from 0 to `RANGE_M`; with a stroke at each bound beyond its end."""
    if width < 1:
        return []
    look = ink_of(metres, bounds)
    if math.isnan(metres):
        return [Ink(("? " * width)[:width], look)]
    if math.isinf(metres) and metres > 0:
        return [Ink("━" * (width - 1) + "▶", look)]
    eighths = round(8 * width * min(max(metres, 0.0), RANGE_M) / RANGE_M)
    full, part = divmod(eighths, 8)
    filled = "█" * full + (EIGHTHS[part] if part else "")
    if metres > RANGE_M:
        filled = "█" * (width - 1) + "▶"
    rest = ["·"] * (width - len(filled))
    for mark in bounds:
        place = mark_cell(mark, width) - len(filled)
        if 0 <= place < len(rest):
            rest[place] = "│"
    return [Ink(filled, look), Ink("".join(rest), "muted")]


def mark_cell(metres: float, width: int) -> int:
    return min(width - 1, int(width * metres / RANGE_M))


def scale(width: int, bounds: Bounds) -> Line:
    cells = [" "] * width
    for metres, text in (
        (0.0, "0"),
        *((metres, "↑" + decimal(f"{metres:g}")) for metres in bounds),
        (RANGE_M, _("{metres} m").format(metres=decimal(f"{RANGE_M:g}"))),
    ):
        start = min(mark_cell(metres, width), width - len(text))
        place = cells[max(0, start - 1) : start + len(text) + 1]
        if start >= 0 and all(cell == " " for cell in place):
            cells[start : start + len(text)] = text
    return [Ink("".join(cells), "muted")]


def big(text: str, look: str) -> list[Line]:
    rows = ["", "", ""]
    for char in text:
        place = DIGITS.find(char)
        for row in range(3):
            if place >= 0:
                rows[row] += DIGITS3X3_BOLD[3 * place + row].ljust(3)
            else:
                rows[row] += char if row == 2 else " "
    return [[Ink(row, look)] for row in rows]


def trend(values: Iterable[float], width: int, height: int, bounds: Bounds) -> list[Line]:
    """The newest values as columns, the newest on the right; `?` for an invalid reading."""
    shown = list(values)[-width:]
    lines: list[Line] = []
    for row in range(height - 1, -1, -1):
        line: Line = [Ink(" " * (width - len(shown)))]
        line.extend(_column(value, row, height, bounds) for value in shown)
        lines.append(_joined(line))
    return lines


def _column(metres: float, row: int, height: int, bounds: Bounds) -> Ink:
    look = ink_of(metres, bounds)
    if math.isnan(metres):
        return Ink("?" if row == 0 else " ", look)
    share = min(max(metres, 0.0), RANGE_M) / RANGE_M
    eighths = max(1, round(8 * height * share)) - 8 * row
    return Ink(HEIGHTS[min(8, max(0, eighths))], look)


def _joined(line: Line) -> Line:
    joined: Line = []
    for text, look in line:
        if joined and joined[-1].look == look:
            joined[-1] = Ink(joined[-1].text + text, look)
        elif text:
            joined.append(Ink(text, look))
    return joined


def bounds_of(update: GraphUpdate, before: Bounds) -> Bounds:
    """Return the last bounds that the safety node reported; they were `before`.

    Those of the course if none are reported: with a learner's own node, or with none.
    """
    row = row_of(update, SAFETY_STATE)
    if row is None or not row.publishers:
        return COURSE
    sample = newest(update, SAFETY_STATE)
    gate = None if sample is None else gate_in(sample.value)
    return before if gate is None else _told(gate)


def _told(gate: Gate) -> Bounds:
    stop_below_m, slow_m = gate.critical_m, gate.slow_m
    if stop_below_m is None or not 0.0 < stop_below_m < math.inf:
        return COURSE
    if slow_m is not None and stop_below_m < slow_m < math.inf:
        # The speed limit falls to zero towards that distance, so at it the robot stands.
        return Bounds(math.nextafter(stop_below_m, math.inf), slow_m)
    return Bounds(stop_below_m, max(stop_below_m, FREE_FROM_M))


KEPT = 240
BIG_FROM = 5
"""Lines from which on the number is drawn large."""
DIGIT_CELLS = 16
TREND_ROWS = 4
"""Lines of the trend beside other panels."""
ENLARGED_FROM = 18
"""Lines from which on the trend has all that are left."""


class Sonar(Drawing):
    """One sonar: from one line on name, metres and word; then bar, trend, big number and scale."""

    def __init__(self, name: str = "", *, id: str | None = None) -> None:
        """`name` is marked by `N_`: "front", "rear"."""
        super().__init__(id=id)
        self._label = name
        self._bounds = COURSE
        self._values: deque[float] = deque(maxlen=KEPT)
        self._times: deque[float] = deque(maxlen=KEPT)

    def show(self, metres: float, time_s: float) -> None:
        self._values.append(metres)
        self._times.append(time_s)
        self.redraw()

    def set_bounds(self, bounds: Bounds) -> None:
        if bounds != self._bounds:
            self._bounds = bounds
            self.redraw()

    @property
    def has_value(self) -> bool:
        return bool(self._values)

    def draw(self, width: int, height: int) -> list[Line]:
        metres = self._values[-1]
        if height == 1:
            return [self._one_line(width)]
        lines: list[Line] = []
        is_big = height >= BIG_FROM and width >= DIGIT_CELLS
        lines.append(self._head(width, with_number=not is_big))
        if is_big:
            lines += self._digits(metres, width)
        lines.append(bar(metres, width, self._bounds))
        rest = height - len(lines)
        if rest >= 2 and is_big:
            lines.append(scale(width, self._bounds))
            rest -= 1
        if rest > 0:
            lines += self._trend(width, rest, rest if height >= ENLARGED_FROM else TREND_ROWS)
        return lines

    def _digits(self, metres: float, width: int) -> list[Line]:
        digits = big(number(metres), ink_of(metres, self._bounds))
        digits[2] = [*digits[2], Ink(" " + (remark(metres) or _("m")))]
        return [[Ink(" "), *line] if width > DIGIT_CELLS else line for line in digits]

    def _head(self, width: int, *, with_number: bool) -> Line:
        left: Line = [Ink(_(self._label), "strong")] if self._label else []
        metres = self._values[-1]
        if with_number:
            left += [Ink(" "), *self._number(metres)]
        return beside(left, self._word(metres), width)

    def _number(self, metres: float) -> Line:
        words = remark(metres) or _("{metres} m").format(metres=number(metres))
        return [Ink(words, ink_of(metres, self._bounds))]

    def _word(self, metres: float) -> Line:
        if self.stale:
            return [Ink(self.stale_words, "alert")]
        zone = zone_of(metres, self._bounds)
        return [Ink(f" {zone.word} ", zone.look)]

    def _one_line(self, width: int) -> Line:
        metres = self._values[-1]
        name = [Ink(f"{_(self._label)} ", "strong")] if self._label else []
        line = [*name, *self._number(metres), Ink(" "), *self._word(metres), Ink(" ")]
        room = width - cells_of(line)
        if room < 0:
            return beside(self._number(metres), self._word(metres), width)
        return [*line, *(bar(metres, room, self._bounds) if room >= 6 else ())]

    def _trend(self, width: int, rest: int, most: int) -> list[Line]:
        if rest < 3:
            return trend(self._values, width, min(rest, most), self._bounds)
        drawn = trend(self._values, width, min(rest - 1, most), self._bounds)
        return [*drawn, self._span(width)]

    def _span(self, width: int) -> Line:
        first = max(0, len(self._times) - width)
        seconds = self._times[-1] - self._times[first]
        words = _("last {seconds} s").format(seconds=whole(seconds))
        return beside([Ink(words, "muted")], [Ink(_("now"), "muted")], width)


TYPE = "std_msgs/msg/Float32"
TOPICS = {"front": SONAR_FRONT, "rear": SONAR_REAR}


class SonarPanel(Panel):
    """The front sonar, and the rear one if somebody publishes it."""

    DEFAULT_CSS = """
    SonarPanel {
        #rear { display: none; }
        &.-both #rear { display: block; }
        &.-failed #rear { display: none; }
        &.-flat { layout: horizontal; }
        &.-both.-flat #rear { margin-left: 2; }
    }
    """
    title = N_("Sonar")
    least = 2
    weight = 2
    across_below = ALWAYS

    def __init__(self) -> None:
        super().__init__()
        self._bounds = COURSE

    def compose(self) -> ComposeResult:
        yield Sonar(N_("front"), id="front")
        yield Sonar(N_("rear"), id="rear")

    def on_resize(self) -> None:
        self.set_class(self.size.width >= 56 and self.size.height < 16, "-flat")

    def watched(self) -> set[str]:
        return {*TOPICS.values(), SAFETY_STATE}

    def kept(self) -> set[str]:
        """Both sonars, so that the trend has no gap."""
        return set(TOPICS.values())

    def show(self, update: GraphUpdate) -> None:
        if is_published(update, SONAR_REAR):
            # One that has gone silent stays, with a remark.
            self.add_class("-both")
        self._bounds = bounds_of(update, self._bounds)
        for place, topic in TOPICS.items():
            sonar = self.query_one(f"#{place}", Sonar)
            sonar.set_bounds(self._bounds)
            for sample in update.samples.get(topic, ()):
                metres = sample.value.get("data")
                if isinstance(metres, (int, float)):
                    sonar.show(float(metres), sample.received_s)
            if topic in update.samples:
                sonar.show_placeholder(other_type(newest(update, topic), TYPE))
            sonar.show_trouble(*trouble_of(update, topic))
