"""A finding: what is wrong, what to do about it, and links to where it is."""

from __future__ import annotations

from textual.content import Content

from graph.data import GraphUpdate
from graph.findings.finding import GraphFinding
from text import ros2_words
from text.i18n import _, localized
from text.plain import plain
from tui.graph.index import GraphIndex, GraphKind, GraphPlace, head_words
from tui.graph.pane import GraphPane, heading, link, node_links

LONGEST = 600


def goal_of(finding: GraphFinding, update: GraphUpdate | None) -> GraphPlace:
    """Return where to look: the place of the finding, or who asks for it if it does not exist."""
    kind, name = finding.place
    served = {row.name for row in update.services} if update else set()
    if kind == "service" and name not in served and finding.nodes:
        return GraphPlace(GraphKind.NODE, finding.nodes[0])
    return GraphPlace(GraphKind(kind), name)


class FindingPane(GraphPane):
    """Head, what is wrong, what to do, and links."""

    DEFAULT_CSS = """
    FindingPane EmptyNotice { max-height: 60%; padding: 0 1 1 1; }
    """

    def __init__(self, index: GraphIndex, *, id: str) -> None:
        super().__init__(id=id)
        self._index = index

    def ros2_command(self) -> str:
        finding = self._index.finding(self.name_shown)
        if finding is None:
            return ""
        kind, name = finding.place
        commands = {
            "topic": ros2_words.topic_info,
            "action": ros2_words.action_info,
            "service": ros2_words.service_type,
        }
        return commands.get(kind, ros2_words.node_info)(name)

    def redraw(self) -> None:
        finding = self._index.finding(self.name_shown) if self.is_mounted else None
        if finding is None:
            return
        self.head.show(finding.place.name, head_words(finding))
        lines = [
            Content.styled(_("What is wrong"), "$text-muted"),
            Content(plain(localized(finding.what), LONGEST)),
            Content(""),
            Content.styled(_("What to do"), "$text-muted"),
            Content(plain(localized(finding.mend), LONGEST)),
        ]
        self.notice.update(Content("\n").join(lines))
        goal = goal_of(finding, self.graph_now)
        rows = [heading(_("Where")), link(goal, "where")]
        others = [name for name in finding.nodes if GraphPlace(GraphKind.NODE, name) != goal]
        if others:
            rows += [heading(_("Nodes that take part")), *node_links(others, "nodes")]
        self.links.show_links(rows)
