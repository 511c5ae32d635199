"""What the terminal shows until there is something to see."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.content import Content
from textual.screen import Screen
from textual.widget import Widget

from tui.frame.title_bar import TitleBar

if TYPE_CHECKING:
    from textual.app import ComposeResult


class Line(Widget):
    """A line of text."""

    DEFAULT_CSS = "Line { height: 1; width: 1fr; margin: 1 2; }"

    def __init__(self, words: str) -> None:
        super().__init__()
        self._words = words

    def render(self) -> Content:
        return Content(self._words)


class OpeningScreen(Screen[None]):
    """The title and a few words: quick to import and to draw."""

    def __init__(self, words: str) -> None:
        super().__init__()
        self._words = words

    def compose(self) -> ComposeResult:
        """The title above the words."""
        yield TitleBar()
        yield Line(self._words)
