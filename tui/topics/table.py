"""All topics in a table: sorted, filtered, and one of them chosen; columns are dropped when room is short."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from rich.cells import cell_len, set_cell_size
from textual.events import Click
from textual.message import Message
from textual.strip import Strip

from graph.data import TopicRow, Trouble
from graph.housekeeping import is_housekeeping
from text.figures import elapsed, figure
from text.i18n import N_, _
from text.plain import plain
from tui.widgets.figures import UNKNOWN, count_text, seconds_text
from tui.widgets.rows import MARK, Cell, Column, Row, Rows
from tui.widgets.words import word_strips

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


def _number(
    id: str, title: str, width: int, text: Callable[[TopicRow], str], value: Callable[[TopicRow], float]
) -> TopicColumn:
    """A column of figures: the highest value comes first when sorting by it."""
    return TopicColumn(id, title, width, text, lambda row: (value(row), ""), right=True, falling=True)


def _age_key(row: TopicRow) -> SortKey:
    return (float("inf") if row.age_s is None else row.age_s // 1, "")


def _lost_key(row: TopicRow) -> float:
    return -1.0 if row.lost is None else row.lost


COLUMNS = (
    TopicColumn("name", N_("Topic"), 0, lambda row: plain(row.name), lambda row: (0, row.name), least=18),
    TopicColumn("type", N_("Type"), 0, type_text, lambda row: (0, " ".join(row.type_names)), least=18),
    _number("publishers", N_("Pub"), 4, lambda row: str(row.publishers), lambda row: row.publishers),
    _number("subscribers", N_("Sub"), 4, lambda row: str(row.subscribers), lambda row: row.subscribers),
    _number("hz", N_("Hz"), 6, lambda row: hz_text(row.hz), lambda row: _figure(row.hz)),
    _number("bandwidth", N_("Bandwidth"), 10, lambda row: bandwidth_text(row.bytes_per_s),
            lambda row: _figure(row.bytes_per_s)),
    TopicColumn("age", N_("Age"), 7, lambda row: age_text(row.age_s), _age_key, right=True),
    _number("jitter", N_("Jitter"), 8, lambda row: seconds_text(row.jitter_s), lambda row: _figure(row.jitter_s)),
    _number("latency", N_("Latency"), 9, lambda row: seconds_text(row.latency_s), lambda row: _figure(row.latency_s)),
    _number("lost", N_("Lost"), 7, lambda row: count_text(row.lost), _lost_key),
    TopicColumn("state", N_("State"), 15, state_text, _state_key),
)  # fmt: skip
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


_BY_ID = {column.id: column for column in COLUMNS}


@dataclass(frozen=True)
class TopicsOrder:
    """The column to sort by, and what is left out."""

    column_id: str = "name"
    reverse: bool = False
    """Whether the order is the reverse of the column's own."""
    words: str = ""
    """All of them must occur in the topic's name or type."""
    housekeeping: bool = False
    """Whether topics of ROS itself are shown."""

    @property
    def column(self) -> TopicColumn:
        return _BY_ID[self.column_id]

    @property
    def falling(self) -> bool:
        """Whether the highest value comes first."""
        return self.column.falling is not self.reverse

    def by(self, column_id: str) -> TopicsOrder:
        """The order after this column is chosen; choosing it again reverses the order."""
        if column_id == self.column_id:
            return replace(self, reverse=not self.reverse)
        return replace(self, column_id=column_id, reverse=False)

    def next_column(self, column_ids: list[str]) -> TopicsOrder:
        at = column_ids.index(self.column_id) if self.column_id in column_ids else -1
        return replace(self, column_id=column_ids[(at + 1) % len(column_ids)], reverse=False)

    def arranged(self, rows: Iterable[TopicRow]) -> list[TopicRow]:
        """The rows to show, in order; equal ones are sorted by name."""
        words = self.words.casefold().split()
        shown = [row for row in rows if self._shows(row, words)]
        shown.sort(key=lambda row: row.name)
        shown.sort(key=self.column.sort_key, reverse=self.falling)
        return shown

    def _shows(self, row: TopicRow, words: list[str]) -> bool:
        if not self.housekeeping and is_housekeeping(row.name):
            return False
        text = f"{row.name} {' '.join(row.type_names)}".casefold()
        return all(word in text for word in words)


class TopicsTable(Rows):
    """Shows `TopicRow`s; one is chosen, and stays chosen while rows come, go and are sorted."""

    class Arranged(Message):
        """The order, the filter or the set of topics has changed."""

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._topics: Sequence[TopicRow] = ()
        self._shown: list[TopicRow] = []
        self._order = TopicsOrder()
        self._words = ("", "")
        self._places: tuple[PlacedColumn, ...] = ()

    def show_topics(self, rows: Sequence[TopicRow]) -> None:
        self._topics = rows
        self._arrange()

    def show_words(self, headline: str, detail: str = "") -> None:
        """Set the words that are shown while there are no rows."""
        if (headline, detail) != self._words:
            self._words = (headline, detail)
            if not self._shown:
                self.refresh()

    @property
    def order(self) -> TopicsOrder:
        """The column to sort by, and what is left out."""
        return self._order

    def reorder(self, order: TopicsOrder) -> None:
        if order != self._order:
            self._order = order
            self._arrange()
            self.post_message(self.Arranged())

    def filter(self, words: str) -> None:
        """Show only topics whose name or type contains each of these words."""
        self.reorder(replace(self._order, words=words))

    def sort_by_next(self) -> None:
        self.reorder(self._order.next_column([place.column.id for place in self._places]))

    @property
    def chosen_row(self) -> TopicRow | None:
        return next((row for row in self._shown if row.name == self.chosen), None)

    @property
    def shown(self) -> Sequence[TopicRow]:
        return self._shown

    def on_click(self, event: Click) -> None:
        for place in self._places if event.y == 0 else ():
            if place.x <= event.x - MARK <= place.x + place.width:
                self.reorder(self._order.by(place.column.id))

    def on_language_changed(self) -> None:
        self._place()

    def render_line(self, y: int) -> Strip:
        if y and not self._shown:
            words = self._words
            if self._topics and self._order.words:
                words = (_("no topic matches “{words}”").format(words=self._order.words), "")
            strips = word_strips(words, self.size.width, self.rich_style, self.app.console)
            if y <= len(strips):
                return strips[y - 1]
        return super().render_line(y)

    def _arrange(self) -> None:
        had, at = self._chosen, self._index(self._chosen)
        in_sight = at is not None and 0 <= at - self.scroll_offset.y < self.size.height - 1
        self._shown = self._order.arranged(self._topics)
        names = [row.name for row in self._shown]
        if had not in names:
            # The one that has taken its place; without any, the table has no chosen one.
            self._chosen = names[min(at or 0, len(names) - 1)] if names else ""
        self.show(*self._laid_out())
        if self._chosen != had:
            self.post_message(self.Highlighted(self, self._chosen))
        now = self._index(self._chosen)
        if in_sight and now is not None and now != at:
            self._bring_into_view(now, self.scroll_offset.y)

    def _place(self) -> None:
        self._columns, self._rows = self._laid_out()
        super()._place()

    def _laid_out(self) -> tuple[tuple[Column, ...], tuple[Row, ...]]:
        longest = max((len(row.name) for row in self._shown), default=0)
        self._places = placed(max(1, self.scrollable_size.width - MARK), longest)
        ends = [*(place.x for place in self._places[1:]), self._places[-1].x + self._places[-1].width + 1]
        arrow = "▼" if self._order.falling else "▲"
        columns = []
        for place, end in zip(self._places, ends, strict=True):
            by = place.column is self._order.column
            title = place.fitted(_(place.column.title) + (arrow if by else ""))
            columns.append(Column(title, end - place.x - 1, look="sorted" if by else ""))
        return tuple(columns), tuple(Row(row.name, tuple(self._cells(row))) for row in self._shown)

    def _cells(self, row: TopicRow) -> Iterator[Cell]:
        wrong = has_problem(row)
        for place in self._places:
            yield Cell(place.fitted(place.column.text(row)), "warn" if wrong and place.column.id == "state" else "")
