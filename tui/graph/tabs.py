"""The kinds of the graph as tabs, each with the number of its entries."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content
from textual.message import Message
from textual.style import Style
from textual.widget import Widget

from text.i18n import _
from tui.graph.places import LISTED, TITLES, GraphKind

if TYPE_CHECKING:
    from collections.abc import Mapping

    from textual.geometry import Size


class GraphTabs(Widget):
    """One line; the current kind is bold, and a click chooses another."""

    class Selected(Message):
        """Another kind was chosen."""

        def __init__(self, kind: GraphKind) -> None:
            super().__init__()
            self.kind = kind

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        *("graph-tabs--tab", "graph-tabs--front"),
        *("graph-tabs--bad", "graph-tabs--warn"),
    }
    DEFAULT_CSS = """
    GraphTabs {
        width: auto; height: 1; background: $panel;
        link-style: none; link-color: $foreground; link-background: transparent;
        link-style-hover: reverse;
        .graph-tabs--tab { color: $foreground; }
        .graph-tabs--front { color: $foreground; text-style: bold reverse; }
        .graph-tabs--bad { color: $text-error; text-style: bold; }
        .graph-tabs--warn { color: $text-warning; text-style: bold; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._front = GraphKind.NODE
        self._counts: dict[GraphKind, int] = {}
        self._worst = ""

    def show(self, front: GraphKind, counts: Mapping[GraphKind, int], worst: str) -> None:
        """Show the number of entries of each kind, and which kind is listed.

        `worst` is the meaning of the worst finding: `bad`, `warn` or none.
        """
        if (front, dict(counts), worst) != (self._front, self._counts, self._worst):
            self._front, self._counts, self._worst = front, dict(counts), worst
            self.refresh(layout=True)

    def get_content_width(self, container: Size, viewport: Size) -> int:
        """Return the width of its text."""
        del container, viewport
        return self.render().cell_length

    def action_choose(self, kind: str) -> None:
        """Report that a tab was clicked."""
        self.post_message(self.Selected(GraphKind(kind)))

    def render(self) -> Content:
        """Draw the tabs."""
        parts = []
        for kind in LISTED:
            name = "front" if kind is self._front else "tab"
            if kind is GraphKind.FINDING and name == "tab" and self._worst:
                name = self._worst
            click = Style.from_meta({"@click": f"choose({kind.value!r})"})
            style = self.get_visual_style(f"graph-tabs--{name}") + click
            parts.append(Content.styled(f" {_(TITLES[kind])} {self._counts.get(kind, 0)} ", style))
        return Content("").join(parts)
