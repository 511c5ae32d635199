"""What can be done on the screen of topics; each letter also under its Cyrillic key."""

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
    """What these actions need of the screen of topics."""

    table: TopicsTable
    detail: TopicDetail
    plotting: Plotting

    @property
    def focused(self) -> Widget | None:
        """What has the focus."""

    @property
    def filter(self) -> Input:
        """Where the words of the filter are typed."""

    @property
    def has_message(self) -> bool:
        """Whether a message of the chosen topic is shown, or held."""

    @property
    def shows_image(self) -> bool:
        """Whether the chosen topic carries images."""

    @property
    def can_publish(self) -> bool:
        """Whether there is a graph to publish in."""

    def focus_filter(self) -> None:
        """Put the cursor into the filter."""

    def filter_messages(self) -> None:
        """Put the cursor into the expression that messages are to fit."""

    def show_plot_next(self) -> None:
        """Show the plot in the next of its places."""

    def toggle_field(self) -> None:
        """Plot the number at the cursor, or plot it no more."""

    def toggle_picture(self) -> None:
        """Show an image as a picture, or as a tree."""

    def toggle_endpoints(self) -> None:
        """Show who is on the chosen topic, or its message."""

    def toggle_housekeeping(self) -> None:
        """Show or hide topics of ROS itself."""

    def copy_message(self) -> None:
        """Copy the message that is shown as YAML."""

    def open_publish(self) -> None:
        """Open the dialog that publishes, for the chosen topic."""


class TopicsAction(Action[TopicsTarget]):
    """Something that the screen of topics does, while its table and message are shown."""

    from_elsewhere = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Not while the plot covers all."""
        return not target.plotting.covers_all


class FilterTopics(TopicsAction):
    """Narrow the list down."""

    id = "topics.filter"
    key = "slash,ctrl+f"
    title = N_("Filter")
    means = "find"
    tooltip = N_("Show only topics whose name or type has the words that you type.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Not in the filter itself: there a slash is a slash."""
        return target.focused is not target.filter and not target.plotting.covers_all

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Put the cursor into the filter."""
        target.focus_filter()


class PauseTopic(TopicsAction):
    """Hold the message still."""

    id = "topics.pause"
    key = "p,з"
    title = N_("Pause")
    tooltip = N_("Freeze message and plot, or follow the newest.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Always: the plot can be held too."""
        del target
        return True

    @classmethod
    def label(cls, target: TopicsTarget) -> str:
        """By what it would do now."""
        return N_("Resume") if target.plotting.paused else cls.title

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Pause, or go on."""
        target.plotting.toggle_pause()


class ShowPlot(TopicsAction):
    """The plot beside the rest, alone, or not at all."""

    id = "topics.plot"
    key = "v,м"
    title = N_("Plot")
    means = "another view"
    tooltip = N_("Show the plot beside the message, then alone, then not at all.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """With a field in it."""
        return target.plotting.plot.has_value

    @classmethod
    def label(cls, target: TopicsTarget) -> str:
        """By what it would do now."""
        return _PLOT_LABELS[target.plotting.place.value]

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Show it elsewhere."""
        target.show_plot_next()


_PLOT_LABELS = {"none": N_("Plot"), "beside": N_("Larger"), "alone": N_("Hide plot")}


class TogglePlotField(TopicsAction):
    """A number of the message against time."""

    id = "topics.plot_field"
    key = "V,М"
    title = N_("Plot field")
    tooltip = N_("Plot the number at the cursor against time, or remove it from the plot.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Where there is a message with fields to choose from."""
        return not target.plotting.covers_all and (
            target.detail.front is target.detail.echo or None
        )

    @classmethod
    def shown(cls, target: TopicsTarget) -> bool:
        """Not without a message: there the key says so."""
        return target.has_message

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Take it in, or out."""
        target.toggle_field()


class NextPlotWindow(TopicsAction):
    """How many seconds the plot shows."""

    id = "topics.plot_window"
    key = "z,я"
    title = N_("Time span")
    means = "time span"
    tooltip = N_("Let the plot show 10, 30 or 60 seconds, or 5 minutes.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """With a plot on the screen."""
        return target.plotting.plot.display

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Show more, or the least."""
        target.plotting.plot.next_window()


class ClearPlot(TopicsAction):
    """Remove everything from the plot."""

    id = "topics.plot_clear"
    key = "D,В"
    title = N_("Clear plot")
    tooltip = N_("Remove all fields from the plot.")

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """With a field in it."""
        return target.plotting.plot.has_value

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Take them out."""
        target.plotting.plot.clear()


class CopyMessage(TopicsAction):
    """The message for the clipboard."""

    id = "topics.copy"
    key = "y,н"
    title = N_("Copy")
    tooltip = N_("Copy the message as YAML, as `ros2 topic pub` takes it.")
    footer = True
    from_elsewhere = False

    @classmethod
    def shown(cls, target: TopicsTarget) -> bool:
        """Not without one: there the key says so."""
        return target.has_message

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Copy it."""
        target.copy_message()


class FilterMessages(TopicsAction):
    """Only messages that fit an expression."""

    id = "topics.condition"
    key = "f,а"
    title = N_("Only if")
    means = "only"
    tooltip = N_("Show only messages for which an expression holds: m.data > 0.5; Esc ends it.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Where there is a topic whose messages can be seen."""
        return target.table.chosen is not None and not target.plotting.covers_all

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Put the cursor there."""
        target.filter_messages()


class PictureOrTree(TopicsAction):
    """An image as a picture, or as its fields."""

    id = "topics.picture"
    key = "i,ш"
    title = N_("Picture")
    tooltip = N_("Show an image as a picture, or as a tree of its fields.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Only for images."""
        return target.shows_image and not target.plotting.covers_all

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Show the other one."""
        target.toggle_picture()


class ShowEndpoints(TopicsAction):
    """Who is on the topic."""

    id = "topics.endpoints"
    key = "e,у"
    title = N_("Endpoints")
    means = "nodes behind it"
    tooltip = N_(
        "Show every publisher and subscriber with its QoS, and which of them are incompatible."
    )
    footer = True

    @classmethod
    def label(cls, target: TopicsTarget) -> str:
        """By what it would show now."""
        return N_("Message") if target.detail.as_endpoints else cls.title

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Show the other one."""
        target.toggle_endpoints()


class SortByNext(TopicsAction):
    """Another column to sort by."""

    id = "topics.sort"
    key = "greater_than_sign,Ю"
    title = N_("Sort")
    tooltip = N_("Sort by the next column; a click on a title sorts by that one.")
    footer = True

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Sort by it."""
        target.table.sort_by_next()


class ReverseOrder(TopicsAction):
    """The order turned round."""

    id = "topics.reverse"
    key = "less_than_sign,Б"
    title = N_("Reverse")
    tooltip = N_("Reverse the order of the topics.")

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Turn it round."""
        order = target.table.order
        target.table.reorder(order.by(order.column_id))


class ShowHousekeeping(TopicsAction):
    """Topics of ROS itself."""

    id = "topics.housekeeping"
    key = "a,ф"
    title = N_("All")
    means = "all"
    tooltip = N_("Show or hide topics of ROS itself: /rosout, /parameter_events.")
    footer = True

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Show or hide them."""
        target.toggle_housekeeping()


class OpenPublish(TopicsAction):
    """Open the publishing dialog."""

    id = "topics.publish"
    key = "P,З"
    title = N_("Publish")
    tooltip = N_("Publish a message to the chosen topic or to a new one, once or at a rate.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsTarget) -> bool | None:
        """Only while there is a graph to publish in: a recording takes nothing."""
        return target.can_publish

    @classmethod
    async def run(cls, target: TopicsTarget) -> None:
        """Open the dialog over the screen."""
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
