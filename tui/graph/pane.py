"""What every detail of the graph has: a head with name and facts, and words where there is none."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Static

from text.plain import plain
from tui.frame.host import Host, host_of
from tui.widgets.working import Working

if TYPE_CHECKING:
    from textual.widget import Widget

    from graph.data import GraphUpdate

LONGEST = 300


class EmptyNotice(Static):
    """A headline and what to do, where nothing can be shown."""

    DEFAULT_CSS = """
    EmptyNotice { width: 1fr; height: auto; padding: 0 1; }
    """

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id, markup=False)
        self.said = ("", "")

    def show(self, headline: str, way_out: str = "") -> None:
        """Show these, harmless."""
        if (headline, way_out) != self.said:
            self.said = (headline, way_out)
            parts = [Content.styled(plain(headline, LONGEST), "bold")]
            parts += [Content.styled(plain(way_out, LONGEST), "$text-muted")] if way_out else []
            self.update(Content("\n").join(parts))


class GraphPane(Vertical, Working):
    """Shows one thing of the graph by its name."""

    DEFAULT_CSS = """
    GraphPane { height: 1fr; width: 1fr; }
    """

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.name_shown = ""
        self.everything = False
        """Whether ROS's own things are shown."""

    @property
    def deck(self) -> Host:
        """The app."""
        return host_of(self)

    @property
    def graph_now(self) -> GraphUpdate | None:
        """The newest of the graph."""
        return self.deck.feed.update

    @property
    def is_settling(self) -> bool:
        """Whether something is to be loaded once the choice stands."""
        return False

    def show_name(self, name: str) -> None:
        """Show what has this full name from now on."""
        self.name_shown = name
        self.redraw()

    def redraw(self) -> None:
        """Show how things stand now, in the language spoken now."""

    def relabel(self) -> None:
        """Say everything anew."""
        self.redraw()

    def first(self) -> Widget | None:
        """Return what is focused when somebody goes into the detail."""
        return None

    def warn(self, words: str) -> None:
        """Say why something was not done."""
        self.notify(plain(words, LONGEST), severity="warning", markup=False)
