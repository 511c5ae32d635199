"""What stands on the terminal until there is something to see."""

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
        """Draw it."""
        return Content(self._words)


class OpeningScreen(Screen[None]):
    """The title and a word: imported in no time, drawn in no time."""

    def __init__(self, words: str) -> None:
        """Show these."""
        super().__init__()
        self._words = words

    def compose(self) -> ComposeResult:
        """The title above the word."""
        yield TitleBar()
        yield Line(self._words)
