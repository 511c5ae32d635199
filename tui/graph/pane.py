"""What all details of the graph have: a head with name and facts, links, and words if it is empty."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Static

from text.plain import plain
from tui.frame.host import Host, host_of
from tui.graph.places import GraphKind, GraphPlace
from tui.widgets.rows import Cell, Column, Row, Rows
from tui.widgets.working import Working

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from textual.timer import Timer
    from textual.widget import Widget

    from graph.data import GraphUpdate

LONGEST = 300
"""Characters of a text that are shown."""
ROOM_FOR_NAMES = 0.55
SETTLED_S = 0.12
"""How long a choice must stand before what it needs is loaded: that imports its package."""


class EmptyNotice(Static):
    """A headline and advice, where nothing can be shown."""

    DEFAULT_CSS = """
    EmptyNotice { width: 1fr; height: auto; padding: 0 1; }
    """

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id, markup=False)
        self.said = ("", "")

    def show(self, headline: str, way_out: str = "") -> None:
        """Show these texts with control characters made harmless."""
        if (headline, way_out) != self.said:
            self.said = (headline, way_out)
            parts = [Content.styled(plain(headline, LONGEST), "bold")]
            parts += [Content.styled(plain(way_out, LONGEST), "$text-muted")] if way_out else []
            self.update(Content("\n").join(parts))


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
        """Divide the width among the columns again."""
        if width := self.size.width:
            names = [len(row.cells[0].text) for row in self._shown if len(row.cells) > 1]
            most = max(4, int(width * ROOM_FOR_NAMES))
            self.show([Column("", min(most, max(names, default=0)) or most), Column("")], self._shown)


def heading(words: str) -> Row:
    """Return a row that is only a heading."""
    return Row("", (Cell(words, "dim"),))


def link(place: GraphPlace, section: str, told: str = "") -> Row:
    """Return a row that links to a place, with a remark."""
    cells = (Cell(plain(place.name, LONGEST)), Cell(plain(told, LONGEST), "dim"))
    return Row(place.key(section), cells if told else cells[:1])


def node_links(names: Iterable[str], section: str, told: str = "") -> list[Row]:
    """Return rows that link to these nodes."""
    return [link(GraphPlace(GraphKind.NODE, name), section, told) for name in names]


class GraphPane(Vertical, Working):
    """Shows one thing of the graph by its name."""

    DEFAULT_CSS = """
    GraphPane { height: 1fr; width: 1fr; }
    """
    name_shown = ""
    everything = False
    """Whether what belongs to ROS itself is shown."""
    _settling: Timer | None = None

    @property
    def deck(self) -> Host:
        return host_of(self)

    @property
    def graph_now(self) -> GraphUpdate | None:
        return self.deck.feed.update

    def ros2_command(self) -> str:
        """Return what shows or does the same, as a command line of `ros2`."""
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
        """Whether something is still to be loaded."""
        return self._settling is not None

    def _settle(self) -> None:
        self._settling = None
        self.load()

    def load(self) -> None:
        """Load what the chosen thing needs."""

    def redraw(self) -> None:
        """Show the current state in the current language."""

    def relabel(self) -> None:
        """Redraw in the current language."""
        self.redraw()

    def first(self) -> Widget:
        """Return the widget to focus when the user enters the detail."""
        return self.query_one(GraphLinks)

    def warn(self, words: str) -> None:
        """Say why something was not done."""
        self.notify(plain(words, LONGEST), severity="warning", markup=False)
