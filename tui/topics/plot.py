"""Numeric fields of topics against time, several in one plot.

Drawn without a library: textual-plot and plotext redraw the whole plot for each update, but over
SSH a plot must cost no more than the cells that have changed. Here the window moves by whole cells,
the axis keeps its numbers while they suit, and what has not changed is not sent.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from rich.cells import cell_len
from textual.message import Message

from graph.data import GraphUpdate, Sample
from text.i18n import _, decimal
from text.plain import plain
from tui.topics.plot_history import History, HistoryDots, Numbers, PlotField, Series
from tui.widgets.canvas import Canvas
from tui.widgets.drawing import Drawing, Ink, Line, fit
from tui.widgets.figures import UNKNOWN
from tui.widgets.pixel_canvas import PixelCanvas

WINDOWS_S = (10.0, 30.0, 60.0, 300.0)
LOOKS = ("accent", "second", "good", "warn", "bad", "strong")
NAMES = "ABCDEF"
"""A curve is identified by its letter, whatever its colour."""
_TICKS_S = {10.0: 1.0, 30.0: 5.0, 60.0: 10.0, 300.0: 30.0}
WIDE = 100
"""Width from which on every tick of time has a label, otherwise every other one."""
ROWS_PER_TICK = 4
LEAST_ROWS = 8
"""If fewer rows than these remain for the curves, the legend gets shorter."""
LABEL_LEAST = 5


class TopicPlot(Drawing):
    """Shows up to six fields of any topics, which stay until they are removed."""

    class PlotChanged(Message):
        """The fields, the window or the pause have changed."""

    DEFAULT_CSS = """
    TopicPlot { height: 1fr; }
    """

    def __init__(self) -> None:
        super().__init__()
        self._in_pixels = PixelCanvas(self)
        self._series: list[Series] = []
        self._window_s = WINDOWS_S[1]
        self._now_s = 0.0
        self._paused_s: float | None = None
        self._axis: ValueAxis | None = None

    @property
    def fields(self) -> tuple[PlotField, ...]:
        return tuple(series.field for series in self._series)

    @property
    def topics(self) -> set[str]:
        return {series.field.topic for series in self._series}

    @property
    def paused(self) -> bool:
        """Whether the plot is paused; new messages are kept meanwhile."""
        return self._paused_s is not None

    @property
    def has_value(self) -> bool:
        return bool(self._series)

    def marks(self, topic: str) -> Mapping[tuple[str | int, ...], str]:
        """The letters of a topic's fields, by path."""
        return {series.field.path: series.letter for series in self._series if series.field.topic == topic}

    def toggle(self, wanted: PlotField, newest: Sample | None = None) -> bool:
        """Add a field to the plot, or remove it; return whether it is plotted now.

        `newest` is the message that is already known. A field is not added if there is no letter
        left.
        """
        kept = [series for series in self._series if series.field != wanted]
        if len(kept) == len(self._series):
            if len(kept) >= len(NAMES):
                return False
            place = min(set(range(len(NAMES))) - {NAMES.index(s.letter) for s in kept})
            kept.append(Series(wanted, NAMES[place], LOOKS[place], History()))
            if newest is not None and newest.topic == wanted.topic:
                kept[-1].take(newest)
        added = len(kept) > len(self._series)
        self._series = kept
        self._axis = None
        self.redraw()
        self.post_message(self.PlotChanged())
        return added

    def clear(self) -> None:
        self._series = []
        self._axis = self._paused_s = None
        self.refresh()
        self.post_message(self.PlotChanged())

    def take(self, update: GraphUpdate) -> None:
        self._now_s = update.time_s
        for series in self._series:
            for sample in update.samples.get(series.field.topic, ()):
                series.take(sample)
        if self._series and self.display and not self.paused:
            self.redraw()

    def next_window(self) -> None:
        at = WINDOWS_S.index(self._window_s)
        self._window_s = WINDOWS_S[(at + 1) % len(WINDOWS_S)]
        self._axis = None
        self.redraw()
        self.post_message(self.PlotChanged())

    def pause(self, paused: bool) -> None:
        if paused != self.paused:
            self._paused_s = self._now_s if paused else None
            self.redraw()
            self.post_message(self.PlotChanged())

    def draw(self, width: int, height: int) -> list[Line]:
        end_s = self._now_s if self._paused_s is None else self._paused_s
        title = f"{_('Plot')} · {window_text(self._window_s)}"
        if self.paused:
            title += f" · {_('PAUSED')}"
        if height < len(self._series) + LEAST_ROWS + 3:
            legend = legend_in_short(self._series, width, title)
        else:
            legend = legend_lines(self._series, end_s, self._window_s, width, title)
        rows = height - len(legend) - 1
        return [*legend, *(self._picture(end_s, width, rows) if rows >= 1 else [])]

    def _picture(self, end_s: float, width: int, rows: int) -> list[Line]:
        """Return curves and axes in this many rows of cells, and the times below them."""
        axis = self._axis = self._suiting_axis(end_s, rows)
        labels = {self._row_of(tick, axis, rows): axis.label(tick) for tick in axis.ticks}
        left = max(LABEL_LEAST, *(len(text) for text in labels.values())) + 1
        across = width - left - 2
        if across < 2:
            return []
        # The window ends at a whole cell: the curves move by cells and keep their shape.
        cell_s = self._window_s / across
        edge_s = math.ceil(end_s / cell_s) * cell_s
        ends: dict[int, Ink] = {}

        def drawn(across: int, down: int) -> Canvas:
            canvas = Canvas(across, down)
            ends.clear()
            for series in self._series:
                columns = series.history.columns(edge_s, self._window_s, 2 * across)
                canvas.mask(curve(columns, axis, down), series.look)
                self._letter(series, columns, axis, rows, ends)
            for row in labels:
                canvas.dotted((2 * row + 1) * down // (2 * rows), "muted")
            return canvas

        lines = []
        for row, line in enumerate(self._in_pixels.lines(across, rows, drawn) or drawn(across, rows).lines()):
            label = labels.get(row, "").rjust(left - 1) + ("┤" if row in labels else "│")
            lines.append([Ink(label, "muted"), *line, ends.get(row, Ink(" "))])
        return [*lines, self._times(left, across)]

    def _suiting_axis(self, end_s: float, rows: int) -> ValueAxis:
        ranges = [series.history.range(end_s, self._window_s) for series in self._series]
        known = [one for one in ranges if one is not None]
        low = min((one[0] for one in known), default=0.0)
        high = max((one[1] for one in known), default=1.0)
        return steadied(self._axis, low, high, max(1, rows // ROWS_PER_TICK))

    @staticmethod
    def _row_of(value: float, axis: ValueAxis, rows: int) -> int:
        share = (axis.high - value) / (axis.high - axis.low)
        return min(rows - 1, max(0, round(share * (rows * 4 - 1)) // 4))

    def _letter(self, series: Series, columns: HistoryDots, axis: ValueAxis, rows: int, ends: dict[int, Ink]) -> None:
        """Write the letter beside the curve's end, or above or below it if another is there."""
        numbers = [number for number in columns.last.tolist() if math.isfinite(number)]
        if not numbers:
            return
        row = self._row_of(numbers[-1], axis, rows)
        free = sorted(set(range(rows)) - set(ends), key=lambda place: abs(place - row))
        if free:
            ends[free[0]] = Ink(series.letter, series.look)

    def _times(self, left: int, across: int) -> Line:
        text = " " * (left + across + 1)
        ticks_s = _TICKS_S[self._window_s] * (1 if across >= WIDE else 2)
        for tick in range(int(self._window_s / ticks_s) + 1):
            ago_s = tick * ticks_s
            word = f"-{window_text(ago_s)}" if ago_s else _("now")
            share = 1 - ago_s / self._window_s
            at = min(left + round(share * across) - len(word) // 2, left + across + 1 - len(word))
            at = max(at, 0)
            if not text[max(0, at - 2) : at + len(word) + 1].strip():
                text = text[:at] + word + text[at + len(word) :]
        return [Ink(text, "muted")]


def window_text(seconds: float) -> str:
    """`30 s`, `5 min`."""
    if seconds < 120:
        return _("{n} s").format(n=decimal(f"{seconds:g}"))
    return _("{n} min").format(n=decimal(f"{seconds / 60:g}"))


STEPS = (1.0, 2.0, 5.0, 10.0)
TOO_WIDE = 3.0
"""If the range is narrower than the axis by this factor, the axis is replaced."""
LEAST_SPAN = 1e-9
NEAR = 1e-6
FINER = 4
"""Number of steps of the ends in one tick, which limits the blank space above and below."""
FARTHEST = 1e15
TINIEST = 1e-290
"""Smaller numbers cannot be divided any further."""
PLACES_MOST = 6


@dataclass(frozen=True)
class ValueAxis:
    """From `low` to `high`, both round, with a tick at each multiple of `step` between them."""

    low: float
    high: float
    step: float

    @property
    def ticks(self) -> list[float]:
        first = math.ceil(self.low / self.step - NEAR)
        last = math.floor(self.high / self.step + NEAR)
        return [self.step * number for number in range(first, last + 1)]

    def label(self, value: float) -> str:
        if abs(value) < self.step / 1e3:
            return "0"
        widest = max(abs(self.low), abs(self.high))
        if widest >= 1e6 or self.step < 10**-PLACES_MOST:
            places = max(0, math.floor(math.log10(abs(value))) - math.floor(math.log10(self.step)))
            return f"{value:.{min(places, PLACES_MOST)}e}".replace("e+0", "e").replace("e-0", "e-")
        return f"{value:.{decimals(self.step)}f}"


def decimals(step: float) -> int:
    return max(0, -math.floor(math.log10(step) + 1e-9))


def round_step(span: float, ticks: int) -> float:
    """Return the smallest step (1, 2 or 5 times a power of ten) that covers the span in `ticks`."""
    least = span / max(1, ticks)
    power = 10.0 ** math.floor(math.log10(least))
    return next(step * power for step in STEPS if step * power >= least * (1 - 1e-9))


def axis_for(low: float, high: float, ticks: int) -> ValueAxis:
    """Return an axis with about this many ticks that contains everything from `low` to `high`."""
    low, high = max(-FARTHEST, min(low, FARTHEST)), max(-FARTHEST, min(high, FARTHEST))
    span = high - low
    if span <= LEAST_SPAN * max(1.0, abs(low), abs(high)):
        # A constant value is in the middle, with an axis of its own order of magnitude.
        half = 0.5 * 10.0 ** math.floor(math.log10(abs(low))) if abs(low) > TINIEST else 0.5
        low, high = low - half, high + half
        span = high - low
    fine = round_step(span, FINER * ticks)
    first, last = math.floor(low / fine + NEAR), math.ceil(high / fine - NEAR)
    low, high = first * fine, max(last, first + 1) * fine
    return ValueAxis(low, high, round_step(high - low, ticks))


def steadied(before: ValueAxis | None, low: float, high: float, ticks: int) -> ValueAxis:
    """Keep the axis while it suits, else make a new one: it grows at once and shrinks late."""
    if before is not None and before.low <= low and high <= before.high:
        span = max(high - low, LEAST_SPAN * max(1.0, abs(low), abs(high)))
        near = axis_for(low, high, ticks)
        if near.step >= before.step / TOO_WIDE and (before.high - before.low) < TOO_WIDE * max(
            span, near.high - near.low
        ):
            return before
    return axis_for(low, high, ticks)


DOTS_DOWN = 4


def heights(values: Numbers, axis: ValueAxis, dots: int) -> Numbers:
    """Rows of dots from the top, 0..dots-1, for numbers on this axis; nan stays nan."""
    share = (axis.high - values) / (axis.high - axis.low)
    placed: Numbers = np.clip(np.rint(share * (dots - 1)), 0, dots - 1)
    return placed


def curve(columns: HistoryDots, axis: ValueAxis, rows: int) -> NDArray[np.bool_]:
    dots = rows * DOTS_DOWN
    top, bottom = _reach(columns, axis, dots)
    at = np.arange(dots)[:, None]
    on: NDArray[np.bool_] = (at >= top) & (at <= bottom)
    return on


def _reach(columns: HistoryDots, axis: ValueAxis, dots: int) -> tuple[Numbers, Numbers]:
    """First and last row of each column of dots, including the lines between numbers; nan: none."""
    # Lists: numpy is slower than a loop for single numbers.
    top = heights(columns.high, axis, dots).tolist()
    bottom = heights(columns.low, axis, dots).tolist()
    last = heights(columns.last, axis, dots).tolist()
    seen = np.flatnonzero(np.isfinite(columns.low)).tolist()
    broken = columns.broken.tolist()
    for left, right in pairwise(seen):
        if not broken[right]:
            # From the last number of one column to the nearest number of the next.
            end = min(max(last[left], top[right]), bottom[right])
            _join(top, bottom, (left, last[left]), (right, end))
    return np.array(top), np.array(bottom)


def _join(top: list[float], bottom: list[float], start: tuple[int, float], end: tuple[int, float]) -> None:
    """Draw a line, making each column high enough to connect all dots."""
    (left, begin), (right, finish) = start, end
    slope = (finish - begin) / (right - left)
    one = begin
    for column in range(left, right + 1):
        other = finish if column == right else math.floor(begin + slope * (column + 0.5 - left))
        if math.isnan(top[column]):
            top[column], bottom[column] = min(one, other), max(one, other)
        else:
            top[column] = min(top[column], one, other)
            bottom[column] = max(bottom[column], one, other)
        one = other


FIGURE = 9
LEAST_NAME = 18
FIGURES = 5
HUGE, TINY = 1e6, 1e-4


def legend_lines(series: Sequence[Series], end_s: float, window_s: float, width: int, title: str) -> list[Line]:
    """A title and a line for each field, in columns; without the range if there is little room."""
    titles = (_("last"), _("min"), _("max"))
    shown = 3 if width >= 2 + LEAST_NAME + 3 * (FIGURE + 1) else 1
    longest = max((cell_len(_name(one)) for one in series), default=0)
    room = min(max(LEAST_NAME, longest), max(1, width - 2 - shown * (FIGURE + 1)))
    heads = "".join(" " + title.rjust(FIGURE) for title in titles[:shown])
    lines: list[Line] = [[Ink(fit(title, 2 + room), "strong"), Ink(heads, "muted")]]
    for one in series:
        range_ = one.history.range(end_s, window_s) or (None, None)
        texts = [number_text(number) for number in (one.history.last, *range_)]
        cells = "".join(" " + text.rjust(FIGURE) for text in texts[:shown])
        if not one.is_number:
            cells = " " + _("no number there")
        lines.append([Ink(f"{one.letter} ", one.look), Ink(fit(_name(one), room)), Ink(cells)])
    return lines


def legend_in_short(series: Sequence[Series], width: int, title: str) -> list[Line]:
    """The title, then field and newest number of each, in at most two lines."""
    lines: list[Line] = [[Ink(fit(title, min(width, cell_len(title))), "strong")]]
    room = width - cell_len(title)
    for place, one in enumerate(series):
        number = number_text(one.history.last) if one.is_number else UNKNOWN
        text = f" {one.field.name} {number}"
        if cell_len(text) + 3 > room:
            rest = len(series) - place
            if len(lines) > 1 or cell_len(text) + 3 > width:
                lines[-1].append(Ink(fit(f" +{rest}", max(0, room)), "muted"))
                break
            lines.append([])
            room = width
        lines[-1] += [Ink("  " if lines[-1] else ""), Ink(one.letter, one.look), Ink(text)]
        room -= cell_len(text) + 3
    return lines


def number_text(number: float | None) -> str:
    if number is None:
        return UNKNOWN
    if not math.isfinite(number):
        return str(number)
    if number and not TINY <= abs(number) < HUGE:
        return f"{number:.2e}"
    whole = len(str(int(abs(number))))
    return f"{number:.{max(0, FIGURES - whole)}f}"


def _name(one: Series) -> str:
    return f"{plain(one.field.topic, 200)} {one.field.name}"
