"""Plotting on the Topics screen: which numbers are plotted, and where the plot is shown."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any

from text.i18n import _
from tui.topics.plot_history import PlotField

if TYPE_CHECKING:
    from textual.screen import Screen

    from tui.topics.detail import TopicDetail
    from tui.topics.plot import TopicPlot
    from tui.topics.table import TopicsTable


class PlotPlace(Enum):
    """Where the plot is shown."""

    NONE = "none"
    BESIDE = "beside"
    """Below the message, or below the table."""
    ALONE = "alone"
    """In place of table and message."""


class Plotting:
    """Adds numbers of the current message to a plot, and decides where it is shown.

    The place is expressed by the classes `-plot` and `-plot-alone` of the screen, for its style
    sheet.
    """

    def __init__(self, screen: Screen[Any], table: TopicsTable, detail: TopicDetail, plot: TopicPlot) -> None:
        self.plot = plot
        self._screen = screen
        self._table = table
        self._detail = detail

    @property
    def place(self) -> PlotPlace:
        if not self._screen.has_class("-plot"):
            return PlotPlace.NONE
        return PlotPlace.ALONE if self._screen.has_class("-plot-alone") else PlotPlace.BESIDE

    @property
    def covers_all(self) -> bool:
        """Whether the plot replaces table and message."""
        return self.place is PlotPlace.ALONE

    def show(self, place: PlotPlace) -> None:
        self._screen.set_class(place is not PlotPlace.NONE, "-plot")
        self._screen.set_class(place is PlotPlace.ALONE, "-plot-alone")
        if place is not PlotPlace.ALONE and self._screen.focused is None:
            self._table.focus()
        self._screen.refresh_bindings()

    @property
    def field_at_cursor(self) -> PlotField | None:
        echo = self._detail.echo
        topic, path, message = self._table.chosen, echo.at_cursor, echo.message
        if not topic or path is None or message is None:
            return None
        field = PlotField(topic, path)
        return None if field.number(message) is None else field

    def toggle_field(self) -> bool:
        """Plot the number at the cursor, or remove it; return whether it is plotted now."""
        field = self.field_at_cursor
        if field is None:
            self._warn(_("Put the cursor on a number first: Tab goes to the message."))
        elif self.plot.is_full and field not in self.plot.fields:
            self._warn(_("There is no room for more fields: remove one first."))
        else:
            return self.plot.toggle(field, self._detail.sample)
        return False

    @property
    def paused(self) -> bool:
        plot = self.plot.paused and self.place is not PlotPlace.NONE
        return plot or self._detail.echo.paused

    def toggle_pause(self) -> None:
        """Pause message and plot, or resume both."""
        paused = not self.paused
        self._detail.echo.pause(paused)
        self.plot.pause(paused and self.place is not PlotPlace.NONE)

    def mark_fields(self) -> None:
        self._detail.echo.mark(self.plot.marks(self._table.chosen))

    def _warn(self, words: str) -> None:
        self._screen.notify(words, severity="warning", markup=False)
