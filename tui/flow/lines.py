"""A chain as lines of a table: delay, who, where on the time axis, and what was said."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from rich.cells import cell_len, set_cell_size

from tui.flow import words
from tui.flow.chains import Lane

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tui.flow.chains import Chain, FlowStep

DELAY = 10
NARROW, WIDE = 100, 150
"""Widths of the view from which on more columns are shown."""
SHORTEST_S = 0.001
LINEAR_UP_TO_S = 0.02
"""An axis no longer than this needs no logarithm."""


class FlowColumns(NamedTuple):
    """Widths in cells; the content takes the remaining ones."""

    source: int
    said_by: int
    bar: int
    content: int


@dataclass(frozen=True)
class FlowLine:
    """One row of the view: pieces of text, each with the name of its style."""

    key: tuple[float, int]
    """Start of the chain and number of the step; -1 is the headline, -2 cannot be chosen."""
    pieces: tuple[tuple[str, str], ...]


def columns(width: int) -> FlowColumns:
    """Divide a width among the columns."""
    if width < NARROW:
        source, said_by, bar = 16, 0, max(8, width // 5)
    elif width < WIDE:
        source, said_by, bar = 18, 18, width // 4
    else:
        source, said_by, bar = 24, 26, width // 3
    gaps = 4 if said_by else 3
    return FlowColumns(source, said_by, bar, max(8, width - DELAY - source - said_by - bar - 2 * gaps))


def lines(
    chain: Chain, at: str, shown: Sequence[FlowStep], width: int, *, logarithmic: bool, folded: bool
) -> list[FlowLine]:
    """Lay out a chain; `at` is the time of day of its start, `shown` the steps to show."""
    mark = "▸" if folded else "▾"
    head = f"{mark} {at}  {words.headline(chain, shown)}"
    found = [FlowLine((chain.start_s, -1), ((fit(head, width), "title"),))]
    if folded:
        return found
    room = columns(width)
    last_s = max((chain.delay_s(step) for step in shown), default=0.0)
    axis = TimeAxis(max(last_s, SHORTEST_S), room.bar, logarithmic)
    if took := words.model_took(chain):
        found.append(FlowLine((chain.start_s, -2), ((fit(f"  {took}", width), Lane.BRAIN.value),)))
    found.append(_ruler(chain, axis, room))
    before_s = 0.0
    for number, step in enumerate(shown):
        after_s = chain.delay_s(step)
        found.append(FlowLine((chain.start_s, number), _row(chain, step, axis.bar(before_s, after_s), room)))
        before_s = after_s
    if chain.more:
        found.append(FlowLine((chain.start_s, -2), ((f"{'':{DELAY}}  … +{chain.more}", "dim"),)))
    found.append(FlowLine((chain.start_s, -2), (("", "dim"),)))
    return found


def _row(chain: Chain, step: FlowStep, bar: str, room: FlowColumns) -> tuple[tuple[str, str], ...]:
    lane = step.lane.value
    by = words.said_by(step, chain)
    pieces = [
        (words.delay(chain.delay_s(step)).rjust(DELAY) + "  ", "delay"),
        (fit(step.source, room.source) + "  ", lane),
    ]
    if room.said_by:
        pieces.append((fit("" if by == step.source else by, room.said_by) + "  ", "dim"))
    pieces += [(bar + "  ", lane), (fit(words.content(step), room.content), "content")]
    return tuple(pieces)


def _ruler(chain: Chain, axis: TimeAxis, room: FlowColumns) -> FlowLine:
    blank = " " * (DELAY + 2 + room.source + 2 + (room.said_by + 2 if room.said_by else 0))
    return FlowLine((chain.start_s, -2), ((blank, "dim"), (axis.ruler(), "dim")))


class TimeAxis:
    """A time axis of a given number of cells, from 0 to the end of the chain."""

    def __init__(self, span_s: float, width: int, logarithmic: bool) -> None:
        self._span_s, self._width = span_s, width
        self._logarithmic = logarithmic and span_s > LINEAR_UP_TO_S

    def cell(self, delay_s: float) -> int:
        """The cell of a time, counted from 0."""
        if self._logarithmic:
            share = math.log1p(delay_s / SHORTEST_S) / math.log1p(self._span_s / SHORTEST_S)
        else:
            share = delay_s / self._span_s
        return min(self._width - 1, max(0, round(share * (self._width - 1))))

    def bar(self, before_s: float, after_s: float) -> str:
        """A line from the previous step to this one, which is a dot."""
        begin, end = self.cell(before_s), self.cell(after_s)
        return "·" * begin + "━" * (end - begin) + "●" + " " * (self._width - end - 1)

    def ruler(self) -> str:
        """The axis with its ends, and its middle if there is room, in milliseconds."""
        cells = [" "] * self._width
        places = [0.0, self._span_s]
        if self._width >= 24:
            middle = self._width // 2
            places.insert(1, self._moment(middle))
        for place_s in places:
            text = words.delay(place_s) if place_s else "0"
            at = min(self.cell(place_s), self._width - len(text))
            cells[at : at + len(text)] = text
        return "".join(cells)

    def _moment(self, cell: int) -> float:
        share = cell / (self._width - 1)
        if self._logarithmic:
            return SHORTEST_S * math.expm1(share * math.log1p(self._span_s / SHORTEST_S))
        return share * self._span_s


def fit(text: str, width: int) -> str:
    """The text in exactly `width` cells, with an ellipsis if it was cut."""
    if cell_len(text) <= width:
        return set_cell_size(text, width)
    return set_cell_size(text, max(0, width - 1)) + "…"


STYLES = (*(lane.value for lane in Lane), "title", "delay", "content", "dim")
"""Names of the styles of pieces."""
