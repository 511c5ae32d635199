"""A bare app with panels of chosen sizes side by side, for looking at many states at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import ClassVar

from textual.app import App, ComposeResult
from textual.containers import Vertical
from textual.pilot import Pilot
from textual.widget import Widget

from tui.terminal.bandwidth import Bandwidth
from tui.terminal.pixels import Pixels

Placed = tuple[Widget, tuple[int, int]]
"""A panel, and the columns and rows it gets."""


class Stage(App[None]):
    """Columns of panels, each in a frame."""

    pixels = Pixels()
    CSS: ClassVar[str] = """
    Screen { layout: horizontal; }
    Vertical { width: auto; }
    .frame { border: round $primary; }
    """

    def __init__(self, *columns: Sequence[Placed], fill: Callable[[], None] | None = None) -> None:
        super().__init__()
        self._placed = columns
        self._fill = fill

    def compose(self) -> ComposeResult:
        for column in self._placed:
            with Vertical():
                for panel, (width, height) in column:
                    panel.add_class("frame")
                    panel.styles.width, panel.styles.height = width + 2, height + 2
                    yield panel

    async def filled(self, pilot: Pilot[None]) -> None:
        """Give the panels their values, once they are on screen."""
        await pilot.pause()
        if self._fill is not None:
            self._fill()
        await pilot.pause()


class Bare(App[None]):
    """Nothing but this widget."""

    pixels = Pixels()
    bandwidth = Bandwidth()

    def __init__(self, widget: Widget) -> None:
        super().__init__()
        self._widget = widget

    def compose(self) -> ComposeResult:
        yield self._widget


def rows(panel: Widget) -> list[str]:
    return [panel.render_line(y).text.rstrip() for y in range(panel.size.height)]


def alone(panel: Widget, width: int = 40, height: int = 12) -> Stage:
    return Stage([(panel, (width, height))])
