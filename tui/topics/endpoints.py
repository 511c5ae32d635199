"""All endpoints of a topic with their QoS, in a scrollable view."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Sequence
from typing import ClassVar, NamedTuple

from rich.cells import cell_len
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import Static

from graph.data import EndpointInfo, TopicRow
from graph.qos import LEASE, LIVELINESS, Mismatch, mismatches
from text.i18n import _, localized, ngettext
from text.plain import plain
from tui.widgets.drawing import Ink, Line, fit
from tui.widgets.figures import UNKNOWN, seconds_text
from tui.widgets.trouble import names, pair_words


class TopicEndpoints(VerticalScroll, can_focus=True):
    """Shows publishers and subscribers of a topic, and before them what is incompatible."""

    DEFAULT_CSS = """
    TopicEndpoints {
        width: 1fr; height: 1fr; scrollbar-size-vertical: 1;
        Static { width: 1fr; text-wrap: nowrap; }
    }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("k", "scroll_up", show=False),
        Binding("j", "scroll_down", show=False),
    ]

    def __init__(self) -> None:
        super().__init__()
        self._row: TopicRow | None = None

    def compose(self) -> ComposeResult:
        yield Static(markup=False)

    def show(self, row: TopicRow | None) -> None:
        other = row is None or self._row is None or row.name != self._row.name
        self._row = row
        self._fold()
        if other:
            self.scroll_to(0, 0, animate=False, immediate=True)

    def on_language_changed(self) -> None:
        self._fold()

    def on_resize(self) -> None:
        self._fold()

    def watch_show_vertical_scrollbar(self) -> None:
        self._fold()

    def on_show(self) -> None:
        self._fold()

    def _fold(self) -> None:
        width = self.scrollable_content_region.width
        if width < 1 or not self.is_mounted:
            return
        lines = [] if self._row is None else endpoint_lines(self._row, width)
        words = Content("\n").join(Content.assemble(*((ink.text, LOOKS[ink.look]) for ink in line)) for line in lines)
        shown = self.query_one(Static)
        if words != shown.content:
            shown.update(words)


LOOKS = {"": "", "bad": "bold $text-error", "good": "bold $text-success", "muted": "$text-muted", "strong": "bold"}
MARK = 2
MOST_PAIRS = 12
LONGEST = 400
FITS, MISMATCH = "✓", "✗"
LONGEST_NAME = 256
WIDEST_NODE = 44


def endpoint_lines(row: TopicRow, width: int) -> list[Line]:
    """Return the topic's endpoints in this width: what to fix, publishers, subscribers."""
    pairs = [
        (publisher, subscriber, found)
        for publisher in row.published_by
        for subscriber in row.subscribed_by
        if subscriber.type_name == publisher.type_name
        for found in mismatches([publisher], [subscriber])
    ]
    disagree = len(_types(row)) > 1
    columns = columns_for(width - MARK)
    lines = [*_types_lines(row, width)] if disagree else []
    lines += _pair_lines([found for _publisher, _subscriber, found in pairs], width)
    if not lines and row.published_by and row.subscribed_by:
        lines.append([Ink(f"{FITS} ", "good"), Ink(_("every subscriber hears every publisher"))])
    for side, ends in enumerate((row.published_by, row.subscribed_by)):
        title = _("Subscribers") if side else _("Publishers")
        titles = [f"{title} ({len(ends)})", *(column.title for column in columns[1:])]
        lines += [[], [Ink(" " * MARK), *_cells(titles, columns, ["strong", *["muted"] * len(columns)])]]
        for end in ends:
            # The lease is shown beside the kind.
            at = (pair[2].policy for pair in pairs if end is pair[side])
            bad = {LIVELINESS if policy == LEASE else policy for policy in at}
            lines += _end_lines(end, columns, bad, width, with_type=disagree)
        if not side and row.own_publishers:
            lines.append([Ink(" " * MARK), Ink(_("Deck itself publishes here"))])
        elif not ends:
            lines.append([Ink(" " * MARK), Ink(_("nobody listens") if side else _("nobody publishes"), "muted")])
    lines.append([])
    if any(not end.history or not end.liveliness for end in (*row.published_by, *row.subscribed_by)):
        lines += _wrapped("", _("“–” is unknown: the middleware does not send it."), width, "muted")
    return lines


def _types(row: TopicRow) -> list[str]:
    ends = (*row.published_by, *row.subscribed_by)
    return list(dict.fromkeys(end.type_name for end in ends))


def _types_lines(row: TopicRow, width: int) -> Iterator[Line]:
    words = _("The endpoints use different types; a message passes only between equal types.")
    yield from _wrapped(MISMATCH, words, width, "bad")
    for type_name in _types(row):
        publishers = [end for end in row.published_by if end.type_name == type_name]
        subscribers = [end for end in row.subscribed_by if end.type_name == type_name]
        parts = []
        if publishers:
            parts.append(_("published by {nodes}").format(nodes=names(publishers)))
        if subscribers:
            parts.append(_("expected by {nodes}").format(nodes=names(subscribers)))
        yield from _wrapped("", f"{plain(type_name, LONGEST)}: {', '.join(parts)}", width)


def _pair_lines(found: Sequence[Mismatch], width: int) -> list[Line]:
    # If a node has two identical endpoints, its pairs produce the same text.
    told = list(dict.fromkeys(map(pair_words, found)))
    lines: list[Line] = []
    for words in told[:MOST_PAIRS]:
        lines += _wrapped(MISMATCH, words, width, "bad")
    rest = len(told) - MOST_PAIRS
    if rest > 0:
        more = ngettext("… and {n} more pair", "… and {n} more pairs", rest).format(n=rest)
        lines.append([Ink(" " * MARK), Ink(more, "muted")])
    return lines


def _end_lines(
    end: EndpointInfo, columns: Sequence[EndpointColumn], bad: set[str], width: int, *, with_type: bool
) -> Iterator[Line]:
    mark = Ink(f"{MISMATCH} ", "bad") if bad else Ink(" " * MARK)
    looks = ["bad" if column.title in bad else "" for column in columns]
    texts = [column.text(end) for column in columns]
    yield [mark, *_cells(texts, columns, looks)]
    below = [texts[0]] if cell_len(texts[0]) > columns[0].width else []
    below += [plain(end.type_name, LONGEST)] if with_type else []
    below += [f"{column.title} {column.text(end)}" for column in POLICIES[len(columns) - 1 :]]
    if below:
        yield from _wrapped("", " · ".join(below), width, "muted", indent=2 * MARK)


def _cells(texts: Sequence[str], columns: Sequence[EndpointColumn], looks: Sequence[str]) -> Line:
    last = len(columns) - 1
    return [
        Ink(fit(text, column.width) + ("" if place == last else " "), look)
        for place, (text, column, look) in enumerate(zip(texts, columns, looks, strict=False))
    ]


def _wrapped(mark: str, text: str, width: int, look: str = "", *, indent: int = MARK) -> Iterator[Line]:
    """Yield a mark and a wrapped text beside it; if there is a mark, it carries the look."""
    room = max(8, width - indent)
    for place, part in enumerate(textwrap.wrap(text, room)):
        head = Ink((mark if not place else "").ljust(indent), look if mark else "")
        yield [head, Ink(part, "" if mark else look)]


class EndpointColumn(NamedTuple):
    """One column; the names of the policies are those of ROS in every language, because users type them."""

    title: str
    width: int
    text: Callable[[EndpointInfo], str]


def history_text(end: EndpointInfo) -> str:
    """`keep_last 10`, `keep_all`, or whatever is known of it."""
    if end.history == "keep_last" and end.depth:
        return f"{end.history} {end.depth}"
    if not end.history and end.depth:
        return str(end.depth)
    return end.history or UNKNOWN


def time_text(seconds: float | None) -> str:
    return _("none") if seconds is None else seconds_text(seconds)


def liveliness_text(end: EndpointInfo) -> str:
    """Return the kind, and how long without a sign of life it still counts as alive."""
    if not end.liveliness:
        return UNKNOWN
    lease = "" if end.lease_s is None else f" {seconds_text(end.lease_s)}"
    return end.liveliness + lease


NODE = EndpointColumn("", 20, lambda end: plain(localized(end.called), LONGEST_NAME))
POLICIES = (
    EndpointColumn("reliability", 11, lambda end: end.reliability or UNKNOWN),
    EndpointColumn("durability", 15, lambda end: end.durability or UNKNOWN),
    EndpointColumn("history", 13, history_text),
    EndpointColumn("deadline", 8, lambda end: time_text(end.deadline_s)),
    EndpointColumn("lifespan", 8, lambda end: time_text(end.lifespan_s)),
    EndpointColumn("liveliness", 22, liveliness_text),
)
"""In the order on the screen; the last ones are dropped first when room is short."""


def columns_for(width: int) -> tuple[EndpointColumn, ...]:
    """Return the columns that fit, with one blank between them; the node takes the rest."""
    kept = list(POLICIES)
    while kept and NODE.width + sum(column.width + 1 for column in kept) > width:
        kept.pop()
    spare = width - sum(column.width + 1 for column in kept)
    return (NODE._replace(width=max(1, min(spare, WIDEST_NODE))), *kept)
