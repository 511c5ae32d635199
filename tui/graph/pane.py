"""The list of names, and what all details of the graph have: links, and words if there is nothing."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from textual import getters
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.timer import Timer
from textual.widget import Widget

from graph.data import GraphUpdate
from text.i18n import _, localized
from text.plain import plain
from tui.frame.host import Host, host_of
from tui.graph.index import GraphEntry, GraphKind, GraphPlace
from tui.session.feed import Feed
from tui.widgets.name_head import NameHead
from tui.widgets.rows import Cell, Column, Row, Rows
from tui.widgets.working import Working

LONGEST = 300
ROOM_FOR_NAMES = 0.55
SETTLED_S = 0.12
"""How long a choice must stand before what it needs is loaded: that imports its package."""


class EmptyNotice(NameHead):
    """A headline and advice, where nothing can be shown."""

    DEFAULT_CSS = "EmptyNotice { max-height: 100%; background: transparent; }"


class GraphLinks(Rows):
    """Names, each with a remark beside it; Enter on one goes to the place that it names."""

    def __init__(self) -> None:
        super().__init__(header=False, classes="graph-links")
        self._shown: tuple[Row, ...] = ()

    def show_links(self, rows: Sequence[Row]) -> None:
        """Show these rows; names get the room that they need, up to a little over half."""
        self._shown = tuple(rows)
        self.on_resize()

    def on_resize(self) -> None:
        if width := self.size.width:
            names = [len(row.cells[0].text) for row in self._shown if len(row.cells) > 1]
            most = max(4, int(width * ROOM_FOR_NAMES))
            self.show([Column("", min(most, max(names, default=0)) or most), Column("")], self._shown)


def heading(words: str) -> Row:
    return Row("", (Cell(words, "dim"),))


def link(place: GraphPlace, section: str, told: str = "") -> Row:
    cells = (Cell(plain(place.name, LONGEST)), Cell(plain(told, LONGEST), "dim"))
    return Row(place.key(section), cells if told else cells[:1])


def node_links(names: Iterable[str], section: str, told: str = "") -> list[Row]:
    return [link(GraphPlace(GraphKind.NODE, name), section, told) for name in names]


class GraphList(Rows):
    """Shows names; one that does not fit loses its beginning."""

    def __init__(self) -> None:
        super().__init__(header=False)
        self._listed: tuple[tuple[GraphEntry, bool], ...] = ()
        self._kind = GraphKind.NODE

    @property
    def chosen_name(self) -> str:
        return self.chosen.partition("|")[2]

    def show_entries(self, kind: GraphKind, shown: Sequence[GraphEntry], chosen: str, words: str) -> None:
        listed = [(entry, True) for entry in shown]
        missing = chosen and not words and chosen not in {entry.name for entry in shown}
        # A finding that has gone was fixed.
        if missing and kind is not GraphKind.FINDING:
            # A type does not disappear when nobody uses it.
            listed.append((GraphEntry(chosen), kind is GraphKind.TYPE))
        self._kind, self._listed = kind, tuple(listed)
        self.on_resize()
        if chosen:
            self.choose(f"{kind.value}|{chosen}")

    def on_resize(self) -> None:
        self.show([Column("")], [self._row(entry, there=there) for entry, there in self._listed])

    def _row(self, entry: GraphEntry, *, there: bool) -> Row:
        room = max(4, self.size.width - 4) if self.size.width else LONGEST
        words = plain(entry.label or entry.name, LONGEST)
        if not there:
            words = f"✗ {words} (" + _("gone") + ")"
        if entry.remark and len(words) + len(entry.remark) + 2 <= room:
            words = f"{words}  {entry.remark}"
        cell = Cell(ended(words, room), entry.meaning if there else "dim")
        return Row(f"{self._kind.value}|{entry.name}", (cell,))


def ended(words: str, room: int) -> str:
    """Return the words, without their middle if they do not fit: both ends are informative."""
    if len(words) <= room:
        return words
    tail = (room - 1) * 2 // 3
    return words[: room - 1 - tail] + "…" + (words[-tail:] if tail else "")


def why_empty(feed: Feed, kind: GraphKind, listed: Sequence[GraphEntry], *, all_key: str) -> tuple[str, str]:
    update = feed.update
    if feed.link is None:
        return _("no lesson is running"), ""
    if update is None:
        return _("reading the graph"), _("Nodes are starting.")
    if update.error:
        return feed.blind, localized(update.error)
    if any(not entry.housekeeping for entry in listed):
        return _("nothing matches the filter"), _("Escape in the filter shows all again.")
    if listed:
        return _("only what ROS itself needs is here"), _("{key} shows it.").format(key=all_key)
    return {
        GraphKind.NODE: (
            _("no node in this domain"),
            _("Nodes of another domain number, or of another computer while discovery is localhost, are not seen."),
        ),
        GraphKind.SERVICE: (_("nobody serves a service"), _("Start a node that does: head_controller is one.")),
        GraphKind.ACTION: (_("nobody serves an action"), _("Start a node that does: drive_to_point is one.")),
        GraphKind.TYPE: (_("no type is in use"), _("Types are those of topics, services and actions.")),
        GraphKind.FINDING: (
            _("no findings"),
            _(
                "Checked: publishers that fight, types that do not agree, QoS, topics and services without "
                "a source, names that nearly match, nodes with one name, clocks. While this list is open, "
                "every topic is measured: lost messages, foreign stamps and silence show up, too."
            ),
        ),
    }[kind]


class GraphPane(Vertical, Working):
    """Shows one thing of the graph by its name."""

    DEFAULT_CSS = """
    GraphPane { height: 1fr; width: 1fr; }
    """
    name_shown = ""
    everything = False
    """Whether what belongs to ROS itself is shown."""
    _settling: Timer | None = None
    head = getters.query_one(NameHead)
    notice = getters.query_one(EmptyNotice)
    links = getters.query_one(GraphLinks)

    def compose(self) -> ComposeResult:
        yield NameHead()
        yield EmptyNotice()
        yield GraphLinks()

    @property
    def deck(self) -> Host:
        return host_of(self)

    @property
    def graph_now(self) -> GraphUpdate | None:
        return self.deck.feed.update

    def ros2_command(self) -> str:
        return ""

    def show_name(self, name: str) -> None:
        """Show the thing with this full name from now on; load what it needs once the choice stands."""
        if name != self.name_shown:
            if self._settling is not None:
                self._settling.stop()
            self._settling = self.set_timer(SETTLED_S, self._settle)
        self.name_shown = name
        self.redraw()

    @property
    def is_settling(self) -> bool:
        return self._settling is not None

    def _settle(self) -> None:
        self._settling = None
        self.load()

    def load(self) -> None:
        """Load what the chosen thing needs."""

    def redraw(self) -> None:
        """Show the current state in the current language."""

    def on_language_changed(self) -> None:
        self.redraw()

    def first(self) -> Widget:
        return self.links

    def warn(self, words: str) -> None:
        self.notify(plain(words, LONGEST), severity="warning", markup=False)
