"""All topics in a table: sorted, filtered, and one of them chosen; columns are dropped when room is short."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from textual.events import Click
from textual.message import Message
from textual.strip import Strip

from graph.data import TopicRow, Trouble
from graph.housekeeping import is_housekeeping
from text.figures import elapsed, figure
from text.i18n import N_, _, localized
from text.plain import plain
from tui.frame import title
from tui.frame.host import Host
from tui.topics.actions import show_housekeeping
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
    behind: str = ""
    """A blank after right-aligned figures that a word may follow."""


def hz_text(hz: float | None) -> str:
    if hz is None:
        return UNKNOWN
    if hz >= WHOLE_FROM:
        return figure(hz, 0)
    return figure(hz, 1 if hz >= 1 or not hz else 2)


def bandwidth_text(bytes_per_s: float | None) -> str:
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
    if len(row.type_names) > 1:
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
    id: str,
    title: str,
    width: int,
    text: Callable[[TopicRow], str],
    value: Callable[[TopicRow], float],
    behind: str = "",
) -> TopicColumn:
    """A column of figures: the highest value comes first when sorting by it."""
    return TopicColumn(id, title, width, text, lambda row: (value(row), ""), True, True, behind=behind)


COLUMNS = (
    TopicColumn("name", N_("Topic"), 0, lambda row: plain(row.name), lambda row: (0, row.name), least=18),
    TopicColumn("type", N_("Type"), 0, type_text, lambda row: (0, " ".join(row.type_names)), least=18),
    _number("publishers", N_("Pub"), 4, lambda row: str(row.publishers), lambda row: row.publishers),
    _number("subscribers", N_("Sub"), 4, lambda row: str(row.subscribers), lambda row: row.subscribers),
    _number("hz", N_("Hz"), 6, lambda row: hz_text(row.hz), lambda row: _figure(row.hz)),
    _number("bandwidth", N_("Bandwidth"), 10, lambda row: bandwidth_text(row.bytes_per_s),
            lambda row: _figure(row.bytes_per_s)),
    TopicColumn("age", N_("Age"), 8, lambda row: age_text(row.age_s),
                lambda row: (math.inf if row.age_s is None else row.age_s // 1, ""), right=True, behind=" "),
    _number("jitter", N_("Jitter"), 8, lambda row: seconds_text(row.jitter_s), lambda row: _figure(row.jitter_s)),
    _number("latency", N_("Latency"), 9, lambda row: seconds_text(row.latency_s), lambda row: _figure(row.latency_s)),
    _number("lost", N_("Lost"), 8, lambda row: count_text(row.lost),
            lambda row: -1.0 if row.lost is None else row.lost, behind=" "),
    TopicColumn("state", N_("State"), 15, state_text, _state_key),
)  # fmt: skip

_EXTRA = frozenset({"jitter", "latency", "lost"})
"""All or none of them, if there is room to spare: they are shown above the message too."""
LONG_NAME, COMFORT = 30, 8
"""Cells of a name, and of a type beyond its minimum, that come before the extra columns."""
_GIVEN_UP = ("type", "subscribers", "publishers", "bandwidth", "age", "state", "hz")
"""The order in which columns are dropped when room is short."""


def fitting(width: int, longest_name: int = 0) -> list[tuple[TopicColumn, int]]:
    """Return the columns that fit into this width, each with its own.

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
    has_types = sum(not column.width for column in kept) > 1
    to_names = min(spare, max(0, longest_name - COLUMNS[0].least)) if has_types else spare
    shares = {"name": to_names, "type": spare - to_names}
    return [(one, min(width, (one.width or one.least) + shares.get(one.id, 0))) for one in kept]


def _least(columns: Sequence[TopicColumn]) -> int:
    return sum(column.width or column.least for column in columns) + len(columns) - 1


_BY_ID = {column.id: column for column in COLUMNS}


@dataclass(frozen=True)
class TopicsOrder:
    """The column to sort by, and what is left out."""

    column_id: str = "name"
    reverse: bool = False
    words: str = ""
    """All of them must occur in the topic's name or type."""
    housekeeping: bool = False
    """Whether topics of ROS itself are shown."""

    @property
    def column(self) -> TopicColumn:
        return _BY_ID[self.column_id]

    @property
    def falling(self) -> bool:
        return self.column.falling is not self.reverse

    def by(self, column_id: str) -> TopicsOrder:
        """The order after this column is chosen; choosing it again reverses the order."""
        if column_id == self.column_id:
            return replace(self, reverse=not self.reverse)
        return replace(self, column_id=column_id, reverse=False)

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

    def __init__(self) -> None:
        super().__init__()
        self._topics: Sequence[TopicRow] = ()
        self.shown: list[TopicRow] = []
        self.order = TopicsOrder()
        self._words = ("", "")
        self._fitting: list[TopicColumn] = []

    def show_topics(self, rows: Sequence[TopicRow]) -> None:
        self._topics = rows
        self._arrange()

    def show_words(self, headline: str, detail: str = "") -> None:
        """Set the words that are shown while there are no rows."""
        if (headline, detail) != self._words:
            self._words = (headline, detail)
            if not self.shown:
                self.refresh()

    def reorder(self, order: TopicsOrder) -> None:
        if order != self.order:
            self.order = order
            self._arrange()
            self.post_message(self.Arranged())

    def filter(self, words: str) -> None:
        self.reorder(replace(self.order, words=words))

    def sort_by_next(self) -> None:
        ids = [column.id for column in self._fitting]
        at = ids.index(self.order.column_id) if self.order.column_id in ids else -1
        self.reorder(replace(self.order, column_id=ids[(at + 1) % len(ids)], reverse=False))

    @property
    def chosen_row(self) -> TopicRow | None:
        return next((row for row in self.shown if row.name == self.chosen), None)

    def on_click(self, event: Click) -> None:
        at = self.column_at(event.x)
        if event.y == 0 and at is not None:
            self.reorder(self.order.by(self._fitting[at].id))

    def on_language_changed(self) -> None:
        self._place()

    def render_line(self, y: int) -> Strip:
        if y and not self.shown:
            words = self._words
            if self._topics and self.order.words:
                words = (_("no topic matches “{words}”").format(words=self.order.words), "")
            strips = word_strips(words, self.size.width, self.rich_style, self.app.console)
            if y <= len(strips):
                return strips[y - 1]
        return super().render_line(y)

    def _arrange(self) -> None:
        had, at = self.chosen, self._index(self.chosen)
        in_sight = at is not None and 0 <= at - self.scroll_offset.y < self.size.height - 1
        self.shown = self.order.arranged(self._topics)
        columns, rows = self._laid_out()
        self.show(columns, rows, near=at or 0)
        now = self._index(self.chosen)
        if now is None and had:
            self.post_message(self.Highlighted(self, ""))
        elif in_sight and now is not None and now != at:
            self._bring_into_view(now, self.scroll_offset.y)

    def _place(self) -> None:
        self._columns, self._rows = self._laid_out()
        super()._place()

    def _laid_out(self) -> tuple[tuple[Column, ...], tuple[Row, ...]]:
        longest = max((len(row.name) for row in self.shown), default=0)
        fits = fitting(max(1, self.scrollable_size.width - MARK), longest)
        self._fitting = [column for column, _width in fits]
        arrow = "▼" if self.order.falling else "▲"
        columns = []
        for column, width in fits:
            by = column is self.order.column
            title = _(column.title) + (arrow if by else "") + column.behind
            columns.append(Column(title, width, column.right, "sorted" if by else ""))
        return tuple(columns), tuple(Row(row.name, tuple(self._cells(row))) for row in self.shown)

    def _cells(self, row: TopicRow) -> Iterator[Cell]:
        wrong = has_problem(row)
        for column in self._fitting:
            yield Cell(column.text(row) + column.behind, "warn" if wrong and column.id == "state" else "")


def why_empty(deck: Host, listed: Sequence[TopicRow]) -> tuple[str, str]:
    feed = deck.feed
    if feed.link is None:
        return _("no lesson is running"), ""
    if feed.update is not None and feed.update.error:
        return feed.blind, localized(feed.update.error)
    if title.starting(deck):
        return _("no topics yet"), _("Nodes are starting.")
    if feed.update is None or not all(is_housekeeping(row.name) for row in listed):
        return _("no topics yet"), ""
    if not listed:
        return _("no topics"), _("Nobody publishes anything, and nobody listens.")
    key = deck.keys_of(show_housekeeping)[0]
    words = _("There are only those of ROS itself: {key} shows them.").format(key=key)
    return _("no topics of the robot"), words
