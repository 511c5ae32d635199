"""The top line: the screens there are, which one is in front, and what runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from rich.cells import cell_len
from textual.content import Content
from textual.style import Style
from textual.widget import Widget


class TitleBar(Widget):
    """Screens as tabs on the left, each can be clicked; the session on the right."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "title-bar--name",
        "title-bar--tab",
        "title-bar--front",
        "title-bar--state",
    }
    DEFAULT_CSS = """
    TitleBar {
        dock: top;
        height: 1;
        width: 1fr;
        background: $panel;
        color: $foreground;
        link-style: none;
        link-color: $foreground;
        link-background: transparent;
        link-style-hover: reverse;
        .title-bar--name { color: $accent; text-style: bold; }
        .title-bar--tab { color: $foreground; }
        .title-bar--front { color: $foreground; text-style: bold reverse; }
        .title-bar--state { color: $foreground; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._tabs: tuple[tuple[str, str, bool], ...] = ()
        self._states: tuple[str, ...] = ()

    def show(self, tabs: Sequence[tuple[str, str, bool]], states: Sequence[str]) -> None:
        """Show tabs of (text, action, in front), and of `states` the first that fits, right."""
        shown = (tuple(tabs), tuple(states))
        if shown != (self._tabs, self._states):
            self._tabs, self._states = shown
            self.refresh()

    def render(self) -> Content:
        """Draw the tabs, then what fits of the session."""
        parts = [Content.styled(" Deck ", self.get_visual_style("title-bar--name"))]
        for text, action, front in self._tabs:
            style = self.get_visual_style("title-bar--front" if front else "title-bar--tab")
            click = Style.from_meta({"@click": action})
            parts.append(Content.styled(f" {text} ", style + click))
        left = Content("").join(parts)
        room = self.size.width - left.cell_length
        state = next((text for text in self._states if cell_len(text) + 2 <= room), "")
        gap = " " * max(0, room - cell_len(state) - 1)
        return left.append(gap).append(
            Content.styled(state, self.get_visual_style("title-bar--state"))
        )
