"""What can be done on the screen of topics; each letter also under its Cyrillic key."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Action

if TYPE_CHECKING:
    from tui.topics.screen import TopicsScreen


class TopicsAction(Action["TopicsScreen"]):
    """Something that the screen of topics does, while its table and message are shown."""

    from_elsewhere = True

    @classmethod
    def possible(cls, target: TopicsScreen) -> bool | None:
        """Not while the plot covers all."""
        return not target.is_covered


class Filter(TopicsAction):
    """Narrow the list down."""

    id = "topics.filter"
    key = "slash,ctrl+f"
    title = N_("Filter")
    means = "find"
    tooltip = N_("Show only topics whose name or type has the words that you type.")
    footer = True
    priority = True

    @classmethod
    def possible(cls, target: TopicsScreen) -> bool | None:
        """Not in the filter itself: there a slash is a slash."""
        return target.focused is not target.filter and not target.is_covered

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
        """Put the cursor into the filter."""
        target.focus_filter()


class Pause(TopicsAction):
    """Hold the message still."""

    id = "topics.pause"
    key = "p,з"
    title = N_("Pause")
    tooltip = N_("Freeze message and plot, or follow the newest.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsScreen) -> bool | None:
        """Always: the plot can be held too."""
        del target
        return True

    @classmethod
    def label(cls, target: TopicsScreen) -> str:
        """By what it would do now."""
        return N_("Resume") if target.paused else cls.title

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
        """Pause, or go on."""
        target.toggle_pause()


class Plot(TopicsAction):
    """The plot beside the rest, alone, or not at all."""

    id = "topics.plot"
    key = "v,м"
    title = N_("Plot")
    means = "another view"
    tooltip = N_("Show the plot beside the message, then alone, then not at all.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsScreen) -> bool | None:
        """With a field in it."""
        return target.plot.has_value

    @classmethod
    def label(cls, target: TopicsScreen) -> str:
        """By what it would do now."""
        return _PLOT_LABELS[target.plot_place.value]

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
        """Show it elsewhere."""
        target.show_plot_next()


_PLOT_LABELS = {"none": N_("Plot"), "beside": N_("Larger"), "alone": N_("Hide plot")}


class PlotField(TopicsAction):
    """A number of the message against time."""

    id = "topics.plot_field"
    key = "V,М"
    title = N_("Plot field")
    tooltip = N_("Plot the number at the cursor against time, or remove it from the plot.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsScreen) -> bool | None:
        """Where there is a message with fields to choose from."""
        return not target.is_covered and (target.detail.front is target.detail.echo or None)

    @classmethod
    def shown(cls, target: TopicsScreen) -> bool:
        """Not without a message: there the key says so."""
        return target.has_message

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
        """Take it in, or out."""
        target.toggle_field()


class PlotWindow(TopicsAction):
    """How many seconds the plot shows."""

    id = "topics.plot_window"
    key = "z,я"
    title = N_("Time span")
    means = "time span"
    tooltip = N_("Let the plot show 10, 30 or 60 seconds, or 5 minutes.")
    footer = True

    @classmethod
    def possible(cls, target: TopicsScreen) -> bool | None:
        """With a plot on the screen."""
        return target.plot.display

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
        """Show more, or the least."""
        target.plot.next_window()


class ClearPlot(TopicsAction):
    """Nothing plotted any more."""

    id = "topics.plot_clear"
    key = "D,В"
    title = N_("Clear plot")
    tooltip = N_("Remove all fields from the plot.")

    @classmethod
    def possible(cls, target: TopicsScreen) -> bool | None:
        """With a field in it."""
        return target.plot.has_value

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
        """Take them out."""
        target.plot.clear()


class CopyMessage(TopicsAction):
    """The message for the clipboard."""

    id = "topics.copy"
    key = "y,н"
    title = N_("Copy")
    tooltip = N_("Copy the message as YAML, as `ros2 topic pub` takes it.")
    footer = True
    from_elsewhere = False

    @classmethod
    def shown(cls, target: TopicsScreen) -> bool:
        """Not without one: there the key says so."""
        return target.has_message

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
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
    def possible(cls, target: TopicsScreen) -> bool | None:
        """Where there is a topic whose messages can be seen."""
        return target.table.chosen is not None and not target.is_covered

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
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
    def possible(cls, target: TopicsScreen) -> bool | None:
        """Only for images."""
        return target.shows_image and not target.is_covered

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
        """Show the other one."""
        target.toggle_picture()


class Endpoints(TopicsAction):
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
    def label(cls, target: TopicsScreen) -> str:
        """By what it would show now."""
        return N_("Message") if target.detail.as_endpoints else cls.title

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
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
    async def run(cls, target: TopicsScreen) -> None:
        """Sort by it."""
        target.table.sort_by_next()


class Reverse(TopicsAction):
    """The order turned round."""

    id = "topics.reverse"
    key = "less_than_sign,Б"
    title = N_("Reverse")
    tooltip = N_("Reverse the order of the topics.")

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
        """Turn it round."""
        order = target.table.order
        target.table.reorder(order.by(order.column_id))


class Housekeeping(TopicsAction):
    """Topics of ROS itself."""

    id = "topics.housekeeping"
    key = "a,ф"
    title = N_("All")
    means = "all"
    tooltip = N_("Show or hide topics of ROS itself: /rosout, /parameter_events.")
    footer = True

    @classmethod
    async def run(cls, target: TopicsScreen) -> None:
        """Show or hide them."""
        target.toggle_housekeeping()


TOPICS_ACTIONS = (
    Filter,
    Pause,
    Plot,
    PlotField,
    PlotWindow,
    ClearPlot,
    CopyMessage,
    FilterMessages,
    PictureOrTree,
    Endpoints,
    SortByNext,
    Reverse,
    Housekeeping,
)
