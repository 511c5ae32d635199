"""Numeric fields of topics against time, several in one plot.

Drawn without a library: textual-plot and plotext redraw the whole plot for each update, but over
SSH a plot must cost no more than the cells that have changed. Here the window moves by whole cells,
the axis keeps its numbers while they suit, and what has not changed is not sent.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from textual.message import Message

from text.i18n import _, decimal
from tui.topics.plot.axis import ValueAxis, steadied
from tui.topics.plot.field import PlotField, Series
from tui.topics.plot.legend import legend_in_short, legend_lines
from tui.widgets.drawing import Drawing, Ink, Line

if TYPE_CHECKING:
    from collections.abc import Mapping

    from graph.data import GraphUpdate, Sample
    from tui.topics.plot.history import HistoryDots

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

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
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
        """The topics of which every message is needed."""
        return {series.field.topic for series in self._series}

    @property
    def is_full(self) -> bool:
        """Whether no more fields can be added."""
        return len(self._series) >= len(NAMES)

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
        from tui.topics.plot.history import History

        kept = [series for series in self._series if series.field != wanted]
        if len(kept) == len(self._series):
            if self.is_full:
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
        """Add the messages of an update and redraw what has changed."""
        self._now_s = update.time_s
        for series in self._series:
            for sample in update.samples.get(series.field.topic, ()):
                series.take(sample)
        if self._series and self.display and not self.paused:
            self.redraw()

    def next_window(self) -> None:
        """Show a longer window, or the shortest after the longest."""
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
        """Draw a title, the legend, and the curves between their axes."""
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
        from tui.topics.plot.curve import curve
        from tui.topics.plot.grid import PlotGrid

        axis = self._axis = self._suiting_axis(end_s, rows)
        labels = {self._row_of(tick, axis, rows): axis.label(tick) for tick in axis.ticks}
        left = max(LABEL_LEAST, *(len(text) for text in labels.values())) + 1
        across = width - left - 2
        if across < 2:
            return []
        # The window ends at a whole cell: the curves move by cells and keep their shape.
        cell_s = self._window_s / across
        edge_s = math.ceil(end_s / cell_s) * cell_s
        grid = PlotGrid(rows, across, labels)
        ends: dict[int, Ink] = {}
        for number, series in enumerate(self._series, start=1):
            columns = series.history.columns(edge_s, self._window_s, 2 * across)
            grid.draw(curve(columns, axis, rows), number)
            self._letter(series, columns, axis, rows, ends)
        lines = []
        for row, line in enumerate(grid.lines([series.look for series in self._series])):
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
        """Seconds before now below the plot, at round places."""
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
