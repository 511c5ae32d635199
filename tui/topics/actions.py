"""The actions of the Topics screen; each letter also works as the Cyrillic one on its key."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from textual.widget import Widget
    from textual.widgets import Input

    from tui.topics.detail import TopicDetail
    from tui.topics.plotting import Plotting
    from tui.topics.table.table import TopicsTable


class TopicsTarget(Protocol):
    """The part of the Topics screen that its actions use."""

    table: TopicsTable
    detail: TopicDetail
    plotting: Plotting

    @property
    def focused(self) -> Widget | None:
        """The widget that has the focus."""

    @property
    def filter(self) -> Input:
        """The input of the filter."""

    @property
    def has_message(self) -> bool:
        """Whether a message of the chosen topic is shown, possibly paused."""

    @property
    def shows_image(self) -> bool:
        """Whether the chosen topic carries images."""

    @property
    def can_publish(self) -> bool:
        """Whether there is a graph to publish to."""

    def focus_filter(self) -> None:
        """Focus the filter."""

    def filter_messages(self) -> None:
        """Focus the expression that filters messages."""

    def show_plot_next(self) -> None:
        """Show the plot in the next of its places."""

    def toggle_field(self) -> None:
        """Add the number at the cursor to the plot, or remove it."""

    def toggle_picture(self) -> None:
        """Show an image as a picture, or as a tree."""

    def toggle_endpoints(self) -> None:
        """Show the endpoints of the chosen topic, or its message."""

    def toggle_housekeeping(self) -> None:
        """Show or hide topics of ROS itself."""

    def open_publish(self) -> None:
        """Open the dialog that publishes, for the chosen topic."""


class TopicsAction(Action[TopicsTarget]):
    """An action of the Topics screen, while its table and message are shown."""

    from_elsewhere = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Not while the plot covers everything."""
        return not target.plotting.covers_all


class FilterTopics(TopicsAction):
    """Filter the list."""

    id = "topics.filter"
    key = "slash,ctrl+f"
    title = N_("Filter")
    means = "find"
    tooltip = N_("Show only topics whose name or type has the words that you type.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Not in the filter itself, where a slash is typed."""
        return target.focused is not target.filter and not target.plotting.covers_all

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.focus_filter()


class PauseTopic(TopicsAction):
    """Pause the message."""

    id = "topics.pause"
    key = "p,з"
    title = N_("Pause")
    tooltip = N_("Freeze message and plot, or follow the newest.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Always: the plot can be paused too."""
        del target
        return True

    @classmethod
    def label(cls, target: TopicsTarget) -> str:
        """Named after what it would do now."""
        return N_("Resume") if target.plotting.paused else cls.title

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.plotting.toggle_pause()


class ShowPlot(TopicsAction):
    """Show the plot beside the rest, alone, or not at all."""

    id = "topics.plot"
    key = "v,м"
    title = N_("Plot")
    means = "another view"
    tooltip = N_("Show the plot beside the message, then alone, then not at all.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Only with a field in the plot."""
        return target.plotting.plot.has_value

    @classmethod
    def label(cls, target: TopicsTarget) -> str:
        """Named after what it would do now."""
        return _PLOT_LABELS[target.plotting.place.value]

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.show_plot_next()


_PLOT_LABELS = {"none": N_("Plot"), "beside": N_("Larger"), "alone": N_("Hide plot")}


class TogglePlotField(TopicsAction):
    """Plot a number of the message against time."""

    id = "topics.plot_field"
    key = "V,М"
    title = N_("Plot field")
    tooltip = N_("Plot the number at the cursor against time, or remove it from the plot.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Only with a message that has fields to choose from."""
        return not target.plotting.covers_all and (target.detail.front is target.detail.echo or None)

    @classmethod
    def shown(cls, target: TopicsTarget) -> bool:
        """Not without a message; there the key explains why."""
        return target.has_message

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.toggle_field()


class NextPlotWindow(TopicsAction):
    """Change how many seconds the plot shows."""

    id = "topics.plot_window"
    key = "A,Ф"
    title = N_("Time span")
    means = "time axis"
    tooltip = N_("Let the plot show 10, 30 or 60 seconds, or 5 minutes.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Only while the plot is visible."""
        return target.plotting.plot.display

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Show more seconds, or the fewest after the most."""
        target.plotting.plot.next_window()


class ClearPlot(TopicsAction):
    """Remove everything from the plot."""

    id = "topics.plot_clear"
    key = "D,В"
    title = N_("Clear plot")
    tooltip = N_("Remove all fields from the plot.")

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Only with a field in the plot."""
        return target.plotting.plot.has_value

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.plotting.plot.clear()


class CopyMessage(TopicsAction):
    """Copy the message to the clipboard."""

    id = "topics.copy"
    key = "y,н"
    title = N_("Copy")
    tooltip = N_("Copy the message as YAML, as `ros2 topic pub` takes it.")
    footer = True
    from_elsewhere = False

    @classmethod
    def shown(cls, target: TopicsTarget) -> bool:
        """Not without a message; there the key explains why."""
        return target.has_message

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.detail.copy_message()


class FilterMessages(TopicsAction):
    """Show only messages that match an expression."""

    id = "topics.condition"
    key = "f,а"
    title = N_("Condition")
    means = "only"
    tooltip = N_("Show only messages that match an expression such as m.data > 0.5; Esc ends it.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Only with a topic whose messages can be shown."""
        return target.table.chosen is not None and not target.plotting.covers_all

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.filter_messages()


class PictureOrTree(TopicsAction):
    """Show an image as a picture, or as its fields."""

    id = "topics.picture"
    key = "i,ш"
    title = N_("Picture")
    tooltip = N_("Show an image as a picture, or as a tree of its fields.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        return target.shows_image and not target.plotting.covers_all

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.toggle_picture()


class ShowEndpoints(TopicsAction):
    """Show the endpoints of the topic."""

    id = "topics.endpoints"
    key = "I,Ш"
    title = N_("Endpoints")
    means = "nodes behind it"
    tooltip = N_("Show every publisher and subscriber with its QoS, and which of them are incompatible.")
    footer = True

    @classmethod
    def label(cls, target: TopicsTarget) -> str:
        """Named after what it would show now."""
        return N_("Message") if target.detail.as_endpoints else cls.title

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.toggle_endpoints()


class SortByNext(TopicsAction):
    """Sort by another column."""

    id = "topics.sort"
    key = "greater_than_sign,Ю"
    title = N_("Sort")
    tooltip = N_("Sort by the next column; a click on a title sorts by that one.")
    footer = True

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.table.sort_by_next()


class ReverseOrder(TopicsAction):
    """Reverse the order."""

    id = "topics.reverse"
    key = "less_than_sign,Б"
    title = N_("Reverse")
    tooltip = N_("Reverse the order of the topics.")

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        order = target.table.order
        target.table.reorder(order.by(order.column_id))


class ShowHousekeeping(TopicsAction):
    """Show topics of ROS itself."""

    id = "topics.housekeeping"
    key = "a,ф"
    title = N_("All")
    means = "all"
    tooltip = N_("Show or hide topics of ROS itself: /rosout, /parameter_events.")
    footer = True

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.toggle_housekeeping()


class OpenPublish(TopicsAction):
    """Open the publishing dialog."""

    id = "topics.publish"
    key = "P,З"
    title = N_("Publish")
    tooltip = N_("Publish a message to the selected topic or to a new one, once or at a rate.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Only while there is a graph to publish to, which a recording is not."""
        return target.can_publish

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        target.open_publish()


TOPICS_ACTIONS = (
    FilterTopics,
    PauseTopic,
    ShowPlot,
    TogglePlotField,
    NextPlotWindow,
    ClearPlot,
    CopyMessage,
    FilterMessages,
    PictureOrTree,
    ShowEndpoints,
    SortByNext,
    ReverseOrder,
    ShowHousekeeping,
    OpenPublish,
)
