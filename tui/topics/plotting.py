"""What the screen of topics does with its plot: which fields are in it, and where it stands."""

from __future__ import annotations

from enum import Enum

from textual import on

from text.i18n import _
from tui.frame.screen import DeckScreen
from tui.topics.detail import TopicDetail
from tui.topics.plot.field import PlotField
from tui.topics.plot.plot import TopicPlot
from tui.topics.table import TopicsTable


class PlotPlace(Enum):
    """Where the plot is shown."""

    NONE = "none"
    BESIDE = "beside"
    """Below the message, or the table."""
    ALONE = "alone"
    """In place of table and message."""


class TopicsPlotting(DeckScreen):
    """A screen with a table of topics, the chosen one, and a plot."""

    DEFAULT_CSS = """
    TopicsPlotting TopicPlot { display: none; border-top: solid $panel; }
    TopicsPlotting.-plot {
        TopicPlot { display: block; height: 4fr; }
        TopicDetail { height: 3fr; }
        TopicsTable { max-height: 25%; }
    }
    TopicsPlotting.-low.-plot, TopicsPlotting.-flat.-plot {
        TopicPlot { height: 5fr; border-top: none; background: $panel; }
        TopicsTable { max-height: 20%; }
    }
    TopicsPlotting.-wide.-plot {
        #topics-body { layout: grid; grid-size: 2; grid-columns: 2fr 1fr; grid-rows: 1fr 1fr; }
        TopicsTable { width: 1fr; height: 1fr; max-height: 100%; }
        TopicDetail { width: 1fr; height: 1fr; row-span: 2; }
        TopicPlot { height: 1fr; }
    }
    TopicsPlotting.-plot.-plot-alone {
        #topics-body { layout: vertical; }
        TopicsTable, TopicDetail, #topics-bar { display: none; }
        TopicPlot { height: 1fr; border-top: none; }
    }
    """

    @property
    def table(self) -> TopicsTable:
        """The table of topics."""
        return self.query_one(TopicsTable)

    @property
    def detail(self) -> TopicDetail:
        """The chosen topic."""
        return self.query_one(TopicDetail)

    @property
    def plot(self) -> TopicPlot:
        """The fields that are plotted."""
        return self.query_one(TopicPlot)

    def follow_topics(self) -> set[str]:
        """Those of which a field is plotted."""
        return self.plot.topics if self.is_mounted else set()

    @property
    def field_at_cursor(self) -> PlotField | None:
        """The number in the message that the cursor stands on, None if it is none."""
        echo = self.detail.echo
        topic, path, message = self.table.chosen, echo.at_cursor, echo.message
        if topic is None or path is None or message is None:
            return None
        field = PlotField(topic, path)
        return None if field.number(message) is None else field

    def toggle_field(self) -> None:
        """Plot the number at the cursor, or plot it no more."""
        field = self.field_at_cursor
        if field is None:
            self._warn(_("Put the cursor on a number first: Tab goes to the message."))
        elif self.plot.is_full and field not in self.plot.fields:
            self._warn(_("There is no room for more fields: remove one first."))
        elif self.plot.toggle(field, self.detail.sample) and self.plot_place is PlotPlace.NONE:
            self.show_plot(PlotPlace.BESIDE)

    @property
    def plot_place(self) -> PlotPlace:
        """Where the plot is shown."""
        if not self.has_class("-plot"):
            return PlotPlace.NONE
        return PlotPlace.ALONE if self.has_class("-plot-alone") else PlotPlace.BESIDE

    @property
    def is_covered(self) -> bool:
        """Whether the plot stands in place of table and message."""
        return self.plot_place is PlotPlace.ALONE

    def show_plot(self, place: PlotPlace) -> None:
        """Show the plot beside the rest, alone, or not at all."""
        self.set_class(place is not PlotPlace.NONE, "-plot")
        self.set_class(place is PlotPlace.ALONE, "-plot-alone")
        if place is not PlotPlace.ALONE and self.focused is None:
            self.table.focus()
        self.refresh_bindings()

    def show_plot_next(self) -> None:
        """Show the plot in the next of its places."""
        places = list(PlotPlace)
        self.show_plot(places[(places.index(self.plot_place) + 1) % len(places)])

    @property
    def paused(self) -> bool:
        """Whether the message or the plot is held still."""
        plot = self.plot.paused and self.plot_place is not PlotPlace.NONE
        return plot or self.detail.echo.paused

    def toggle_pause(self) -> None:
        """Hold message and plot still, or go on with both."""
        paused = not self.paused
        self.detail.echo.pause(paused)
        self.plot.pause(paused and self.plot_place is not PlotPlace.NONE)

    def mark_plotted(self) -> None:
        """Write the letters of the plot into the message."""
        self.detail.echo.mark(self.plot.marks(self.table.chosen or ""))

    @on(TopicPlot.Changed)
    def _plot_changed(self) -> None:
        if not self.plot.has_value:
            self.show_plot(PlotPlace.NONE)
        self.mark_plotted()
        self.refresh_bindings()
        self.topics_changed()

    def _warn(self, words: str) -> None:
        self.notify(words, severity="warning", markup=False)
