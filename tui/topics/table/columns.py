"""The columns of the table of topics: their texts, and which are dropped when room is short."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from rich.cells import cell_len, set_cell_size

from graph.data import TopicRow, Trouble
from text.figures import elapsed, figure
from text.i18n import N_, _
from text.plain import plain
from tui.widgets.figures import UNKNOWN, count_text, seconds_text

SortKey: TypeAlias = "tuple[float, str]"
UNITS = (N_("B/s"), N_("kB/s"), N_("MB/s"), N_("GB/s"))
STEP = 1000
SOON_S, MINUTE_S, HOUR_S = 1, 60, 3600
WHOLE_FROM = 100

_TROUBLES = {
    Trouble.NO_PUBLISHER: N_("○ no publisher"),
    Trouble.QOS_MISMATCH: N_("✗ QoS mismatch"),
    Trouble.UNKNOWN_TYPE: N_("? unknown type"),
}


@dataclass(frozen=True)
class TopicColumn:
    """One column; a `width` of 0 shares the remaining width."""

    id: str
    title: str
    width: int
    text: Callable[[TopicRow], str]
    sort_key: Callable[[TopicRow], SortKey]
    right: bool = False
    falling: bool = False
    """Whether the highest value comes first when sorting by it."""
    least: int = 0
    """Width below which it is left out."""


def hz_text(hz: float | None) -> str:
    """A rate with three significant digits."""
    if hz is None:
        return UNKNOWN
    if hz >= WHOLE_FROM:
        return figure(hz, 0)
    return figure(hz, 1 if hz >= 1 or not hz else 2)


def bandwidth_text(bytes_per_s: float | None) -> str:
    """A bandwidth with three significant digits and its unit."""
    if bytes_per_s is None:
        return UNKNOWN
    value, step = bytes_per_s, 0
    while value >= STEP - 0.5 and step < len(UNITS) - 1:
        value, step = value / STEP, step + 1
    shown = figure(value, 0 if not step or value >= WHOLE_FROM else 1)
    return f"{shown} {_(UNITS[step])}"


def age_text(age_s: float | None) -> str:
    """An age in whole seconds, minutes or hours, so that it is redrawn only when those change."""
    if age_s is None:
        return UNKNOWN
    if age_s < SOON_S:
        return _("<1 s")
    if age_s < MINUTE_S:
        return _("{n} s").format(n=elapsed(age_s))
    if age_s < HOUR_S:
        return _("{n} min").format(n=elapsed(age_s / MINUTE_S))
    return _("{n} h").format(n=elapsed(age_s / HOUR_S))


def type_text(row: TopicRow) -> str:
    """The types, `std_msgs/Float32` for `std_msgs/msg/Float32`."""
    return plain(" | ".join(name.replace("/msg/", "/") for name in row.type_names))


def has_problem(row: TopicRow) -> bool:
    """Return whether something is wrong; mere silence is usually not."""
    return row.trouble in _TROUBLES


def state_text(row: TopicRow) -> str:
    """A mark and a word: what is wrong, or why there are no figures; empty if all is well."""
    if has_problem(row):
        return _(_TROUBLES[row.trouble]) if row.trouble else ""
    if not row.measured:
        return _("– not measured")
    if row.age_s is None:
        return _("· waiting")
    if row.trouble is Trouble.QUIET:
        return _("· {age} ago").format(age=age_text(row.age_s))
    if "types" in row.facts:
        return _("! types differ")
    return _("! {detail}").format(detail=plain(row.detail, STEP)) if row.detail else ""


def _figure(value: float | None) -> float:
    """Rounded as it is shown, so that rows whose figures look alike do not change places."""
    return -1.0 if value is None else float(f"{value:.2g}")


def _state_key(row: TopicRow) -> SortKey:
    """Troubles, then what is not measured, then what is quiet: without ages, which change."""
    if has_problem(row):
        return 0.0, state_text(row)
    if not row.measured:
        return 1.0, ""
    return (2.0 if row.age_s is None or row.trouble else 3.0), ""


COLUMNS = (
    TopicColumn("name", N_("Topic"), 0, lambda row: plain(row.name), lambda row: (0, row.name), least=18),
    TopicColumn("type", N_("Type"), 0, type_text, lambda row: (0, " ".join(row.type_names)), least=18),
    TopicColumn(
        "publishers",
        N_("Pub"),
        4,
        lambda row: str(row.publishers),
        lambda row: (row.publishers, ""),
        right=True,
        falling=True,
    ),
    TopicColumn(
        "subscribers",
        N_("Sub"),
        4,
        lambda row: str(row.subscribers),
        lambda row: (row.subscribers, ""),
        right=True,
        falling=True,
    ),
    TopicColumn(
        "hz", N_("Hz"), 6, lambda row: hz_text(row.hz), lambda row: (_figure(row.hz), ""), right=True, falling=True
    ),
    TopicColumn(
        "bandwidth",
        N_("Bandwidth"),
        10,
        lambda row: bandwidth_text(row.bytes_per_s),
        lambda row: (_figure(row.bytes_per_s), ""),
        right=True,
        falling=True,
    ),
    TopicColumn(
        "age",
        N_("Age"),
        7,
        lambda row: age_text(row.age_s),
        lambda row: (float("inf") if row.age_s is None else row.age_s // 1, ""),
        right=True,
    ),
    TopicColumn(
        "jitter",
        N_("Jitter"),
        8,
        lambda row: seconds_text(row.jitter_s),
        lambda row: (_figure(row.jitter_s), ""),
        right=True,
        falling=True,
    ),
    TopicColumn(
        "latency",
        N_("Latency"),
        9,
        lambda row: seconds_text(row.latency_s),
        lambda row: (_figure(row.latency_s), ""),
        right=True,
        falling=True,
    ),
    TopicColumn(
        "lost",
        N_("Lost"),
        7,
        lambda row: count_text(row.lost),
        lambda row: (-1.0 if row.lost is None else row.lost, ""),
        right=True,
        falling=True,
    ),
    TopicColumn("state", N_("State"), 15, state_text, _state_key),
)
"""In the order on the screen."""

_EXTRA = frozenset({"jitter", "latency", "lost"})
"""All or none of them, if there is room to spare: they are shown above the message too."""
LONG_NAME, COMFORT = 30, 8
"""Cells of a name, and of a type beyond its minimum, that come before the extra columns."""
_GIVEN_UP = ("type", "subscribers", "publishers", "bandwidth", "age", "state", "hz")
"""The order in which columns are dropped when room is short."""


@dataclass(frozen=True)
class PlacedColumn:
    """A column at its place in a row."""

    column: TopicColumn
    x: int
    width: int

    def fitted(self, text: str) -> str:
        """The text padded to the width of the column, or cut with an ellipsis."""
        blank = self.width - cell_len(text)
        if blank < 0:
            return set_cell_size(text, max(0, self.width - 1)) + "…"
        return " " * blank + text if self.column.right else text + " " * blank


def placed(width: int, longest_name: int = 0) -> tuple[PlacedColumn, ...]:
    """The columns that fit into this width, with their gaps.

    The room beyond the minimum widths goes to the names until the longest fits, and then to the
    types; if there is no column for types, all of it goes to the names.
    """
    kept = list(COLUMNS)
    names = max(0, min(longest_name, LONG_NAME) - COLUMNS[0].least)
    if _least(kept) + names + COMFORT > width:
        kept = [column for column in kept if column.id not in _EXTRA]
    for unneeded in _GIVEN_UP:
        if _least(kept) <= width:
            break
        kept = [column for column in kept if column.id != unneeded]
    spare = max(0, width - _least(kept))
    flexible = [column for column in kept if not column.width]
    places: list[PlacedColumn] = []
    x = 0
    for column in kept:
        share = spare if column is flexible[-1] else 0
        if column is flexible[0] and len(flexible) > 1:
            share = min(spare, max(0, longest_name - column.least))
            spare -= share
        wide = min(width, (column.width or column.least) + share)
        places.append(PlacedColumn(column, x, wide))
        x += wide + _gap(column)
    return tuple(places)


def _least(columns: list[TopicColumn]) -> int:
    gaps = sum(_gap(column) for column in columns[:-1])
    return sum(column.width or column.least for column in columns) + gaps


def _gap(column: TopicColumn) -> int:
    """Cells after a column: two where right-aligned figures may be followed by a word."""
    return 2 if column.id in {"age", "lost"} else 1
