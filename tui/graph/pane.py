"""What all details of the graph have: a head with name and facts, and words if it is empty."""

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


class GraphPane(Vertical, Working):
    """Shows one thing of the graph by its name."""

    DEFAULT_CSS = """
    GraphPane { height: 1fr; width: 1fr; }
    """

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.name_shown = ""
        self.everything = False
        """Whether what belongs to ROS itself is shown."""

    @property
    def deck(self) -> Host:
        return host_of(self)

    @property
    def graph_now(self) -> GraphUpdate | None:
        return self.deck.feed.update

    def ros2_command(self) -> str:
        """Return what shows or does the same, as a command line of `ros2`."""
        return ""

    @property
    def is_settling(self) -> bool:
        """Whether something is to be loaded once the choice stands."""
        return False

    def show_name(self, name: str) -> None:
        """Show the thing with this full name from now on."""
        self.name_shown = name
        self.redraw()

    def redraw(self) -> None:
        """Show the current state in the current language."""

    def relabel(self) -> None:
        """Redraw in the current language."""
        self.redraw()

    def first(self) -> Widget | None:
        """Return the widget to focus when the user enters the detail."""
        return None

    def warn(self, words: str) -> None:
        """Say why something was not done."""
        self.notify(plain(words, LONGEST), severity="warning", markup=False)
