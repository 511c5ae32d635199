"""The sonar gauge: the distance to the nearest obstacle, what it means, and its trend."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from textual.containers import Container

from graph.data import Trouble
from text.figures import whole
from text.i18n import N_, _
from tui.panels.sonar.bar import bar, big, ink_of, scale, trend
from tui.panels.sonar.words import COURSE, Bounds, number, remark, zone_of
from tui.widgets.drawing import Drawing, Ink, Line, beside, cells_of

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.events import Resize

    from tui.widgets.drawing import Placeholder

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

    def __init__(self, name: str = "", *, id: str | None = None, classes: str | None = None) -> None:
        """`name` is marked by `N_`: "front", "rear"."""
        super().__init__(id=id, classes=classes)
        self._label = name
        self._bounds = COURSE
        self._values: deque[float] = deque(maxlen=KEPT)
        self._times: deque[float] = deque(maxlen=KEPT)

    def show(self, metres: float, time_s: float) -> None:
        """Take a reading in metres at a time in seconds."""
        self._values.append(metres)
        self._times.append(time_s)
        self.redraw()

    def set_bounds(self, bounds: Bounds) -> None:
        """Show STOP and CLOSE below these distances from now on."""
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


class SonarView(Container):
    """The front sonar and, if there is one, the rear sonar."""

    DEFAULT_CSS = """
    SonarView {
        layout: vertical;
        &.-flat { layout: horizontal; }
        #rear { display: none; }
        &.-both #rear { display: block; }
        &.-both.-flat #rear { margin-left: 2; }
    }
    """

    def compose(self) -> ComposeResult:
        """The front sonar above, or to the left of, the rear one."""
        yield Sonar(N_("front"), id="front")
        yield Sonar(N_("rear"), id="rear")

    def show(self, place: str, metres: float, time_s: float) -> None:
        """Take a reading of the sonar at `front` or `rear`."""
        self._sonar(place).show(metres, time_s)

    def show_placeholder(self, place: str, words: Placeholder | None) -> None:
        """Show these words in place of the sonar at `front` or `rear`; if empty, show it again."""
        self._sonar(place).show_placeholder(words)

    def show_trouble(self, place: str, trouble: Trouble | None, detail: str = "", age_s: float | None = None) -> None:
        """Say why there are no readings of the sonar at `front` or `rear`."""
        self._sonar(place).show_trouble(trouble, detail, age_s)

    def set_bounds(self, bounds: Bounds) -> None:
        """Show STOP and CLOSE below these distances from now on."""
        for sonar in self.query(Sonar):
            sonar.set_bounds(bounds)

    def set_both(self, both: bool) -> None:
        """Set whether there is a rear sonar to be shown."""
        self.set_class(both, "-both")

    def on_resize(self, event: Resize) -> None:
        """Place them side by side if that leaves more lines to each."""
        self.set_class(event.size.width >= 56 and event.size.height < 16, "-flat")

    def _sonar(self, place: str) -> Sonar:
        return self.query_one(f"#{place}", Sonar)
