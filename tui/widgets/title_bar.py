"""The top line: the screens there are, which one is in front, and what runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from rich.cells import cell_len, set_cell_size
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
        "title-bar--alarm",
    }
    DEFAULT_CSS = """
    TitleBar {
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
        .title-bar--alarm { color: #000000; background: #ffb000; text-style: bold; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._tabs: tuple[tuple[str, str, bool], ...] = ()
        self._states: tuple[str, ...] = ()
        self._alarm = False

    def show(
        self, tabs: Sequence[tuple[str, str, bool]], states: Sequence[str], *, alarm: bool = False
    ) -> None:
        """Show tabs of (text, action, in front), and of `states` the first that fits, right.

        Where none fits, what can be shown of the last; `alarm` makes it stand out.
        """
        shown = (tuple(tabs), tuple(states), alarm)
        if shown != (self._tabs, self._states, self._alarm):
            self._tabs, self._states, self._alarm = shown
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
        state = next((text for text in self._states if cell_len(text) + 3 <= room), "")
        if self._states and not state:
            state = _cut(self._states[-1], room - 3)
        gap = " " * max(0, room - cell_len(state) - 2)
        style = self.get_visual_style("title-bar--alarm" if self._alarm else "title-bar--state")
        return left.append(gap).append(Content.styled(f" {state} ", style))


def _cut(text: str, room: int) -> str:
    return set_cell_size(text, room - 1).rstrip() + "…" if room > 1 else ""
