"""A finding: what is wrong, what to do about it, and links to where it is."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, cast

from textual.content import Content
from textual.widgets import Static

from text import ros2_words
from text.i18n import _, localized
from text.plain import plain
from tui.graph.finding_words import head_words
from tui.graph.links import GraphLinks, heading, link, node_links
from tui.graph.pane import GraphPane
from tui.graph.places import GraphKind, GraphPlace
from tui.widgets.name_head import NameHead

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.widget import Widget

    from graph.data import GraphUpdate
    from graph.findings.finding import GraphFinding
    from tui.graph.finding_words import FindingsBook
    from tui.graph.index import GraphIndex

LONGEST = 600


class HasFindings(Protocol):
    """The part of the screen that the pane uses."""

    index: GraphIndex


def goal_of(finding: GraphFinding, update: GraphUpdate | None) -> GraphPlace:
    """Return where to look: the place of the finding, or who asks for it if it does not exist."""
    kind, name = finding.place
    served = {row.name for row in update.services} if update else set()
    if kind == "service" and name not in served and finding.nodes:
        return GraphPlace(GraphKind.NODE, finding.nodes[0])
    return GraphPlace(GraphKind(kind), name)


def place_meant(here: GraphPlace | None, book: FindingsBook, update: GraphUpdate | None) -> GraphPlace | None:
    """Return the chosen place; in place of a finding, where to look."""
    if here is None or here.kind is not GraphKind.FINDING:
        return here
    finding = book.get(here.name)
    return None if finding is None else goal_of(finding, update)


class FindingPane(GraphPane):
    """Head, what is wrong, what to do, and links."""

    DEFAULT_CSS = """
    FindingPane {
        #finding-words { width: 1fr; height: auto; max-height: 60%; padding: 0 1 1 1; }
        GraphLinks { height: 1fr; }
    }
    """

    def compose(self) -> ComposeResult:
        yield NameHead()
        yield Static(id="finding-words", markup=False)
        yield GraphLinks()

    @property
    def finding(self) -> GraphFinding | None:
        """The finding that is shown, if it still holds."""
        return cast("HasFindings", self.screen).index.findings.get(self.name_shown)

    def ros2_command(self) -> str:
        """Return what tells of the place."""
        if self.finding is None:
            return ""
        kind, name = self.finding.place
        if kind == "topic":
            return ros2_words.topic_info(name)
        if kind == "action":
            return ros2_words.action_info(name)
        return ros2_words.service_type(name) if kind == "service" else ros2_words.node_info(name)

    def redraw(self) -> None:
        """Show the finding in the current language."""
        finding = self.finding if self.is_mounted and self.name_shown else None
        if finding is None:
            return
        self.query_one(NameHead).show(finding.place.name, head_words(finding))
        parts = ((_("What is wrong"), localized(finding.what)), (_("What to do"), localized(finding.mend)))
        lines = [
            line
            for title, words in parts
            for line in (Content.styled(title, "$text-muted"), Content(plain(words, LONGEST)), Content(""))
        ]
        self.query_one("#finding-words", Static).update(Content("\n").join(lines[:-1]))
        goal = goal_of(finding, self.graph_now)
        rows = [heading(_("Where")), link(goal, "where")]
        others = [name for name in finding.nodes if GraphPlace(GraphKind.NODE, name) != goal]
        if others:
            rows += [heading(_("Nodes that take part")), *node_links(others, "nodes")]
        self.query_one(GraphLinks).show_links(rows)

    def first(self) -> Widget:
        return self.query_one(GraphLinks)
