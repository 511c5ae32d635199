"""The actions of the Topics screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_
from tui.actions.action import Announce, actions_of

if TYPE_CHECKING:
    from tui.topics.screen import TopicsScreen

action: Announce[TopicsScreen] = Announce()
_PLOT_LABELS = {"none": N_("Plot"), "beside": N_("Larger"), "alone": N_("Hide plot")}


@action(
    "topics.filter",
    "slash,ctrl+f",
    N_("Filter"),
    N_("Show only topics whose name or type has the words that you type."),
    means="find",
    footer=True,
    priority=True,
    anywhere=True,
    when=lambda screen: screen.focused is not screen.filter and not screen.plot_covers_all,
)
def filter_topics(screen: TopicsScreen) -> None:
    screen.set_focus(screen.filter)


@action(
    "topics.pause",
    "p",
    N_("Pause"),
    N_("Freeze message and plot, or follow the newest."),
    footer=True,
    anywhere=True,
    label=lambda screen: N_("Resume") if screen.paused else N_("Pause"),
)
def pause_topic(screen: TopicsScreen) -> None:
    screen.toggle_pause()


@action(
    "topics.plot",
    "v",
    N_("Plot"),
    N_("Show the plot beside the message, then alone, then not at all."),
    means="another view",
    footer=True,
    anywhere=True,
    when=lambda screen: screen.plot.has_value,
    label=lambda screen: _PLOT_LABELS[screen.plot_place],
)
def show_plot(screen: TopicsScreen) -> None:
    places = [*_PLOT_LABELS]
    screen.show_plot(places[(places.index(screen.plot_place) + 1) % len(places)])


@action(
    "topics.plot_field",
    "V",
    N_("Plot field"),
    N_("Plot the number at the cursor against time, or remove it from the plot."),
    footer=True,
    anywhere=True,
    when=lambda screen: not screen.plot_covers_all and (screen.detail.front is screen.detail.echo or None),
    shown=lambda screen: screen.has_message,
)
def toggle_plot_field(screen: TopicsScreen) -> None:
    screen.toggle_field()


@action(
    "topics.plot_window",
    "A",
    N_("Time span"),
    N_("Let the plot show 10, 30 or 60 seconds, or 5 minutes."),
    means="time axis",
    footer=True,
    anywhere=True,
    when=lambda screen: screen.plot.display,
)
def next_plot_window(screen: TopicsScreen) -> None:
    screen.plot.next_window()


@action(
    "topics.plot_clear",
    "D",
    N_("Clear plot"),
    N_("Remove all fields from the plot."),
    anywhere=True,
    when=lambda screen: screen.plot.has_value,
)
def clear_plot(screen: TopicsScreen) -> None:
    screen.plot.clear()


def _shows_table(screen: TopicsScreen) -> bool | None:
    return not screen.plot_covers_all


@action(
    "topics.copy",
    "y",
    N_("Copy"),
    N_("Copy the message as YAML, as `ros2 topic pub` takes it."),
    footer=True,
    when=_shows_table,
    shown=lambda screen: screen.has_message,
)
def copy_message(screen: TopicsScreen) -> None:
    screen.detail.copy_message()


@action(
    "topics.condition",
    "f",
    N_("Condition"),
    N_("Show only messages that match an expression such as m.data > 0.5; Esc ends it."),
    means="only",
    footer=True,
    priority=True,
    anywhere=True,
    when=lambda screen: bool(screen.table.chosen) and not screen.plot_covers_all,
)
def filter_messages(screen: TopicsScreen) -> None:
    screen.detail.show_as_endpoints(False)
    screen.detail.filter.open()


@action(
    "topics.picture",
    "i",
    N_("Picture"),
    N_("Show an image as a picture, or as a tree of its fields."),
    footer=True,
    anywhere=True,
    when=lambda screen: screen.shows_image and not screen.plot_covers_all,
)
def picture_or_tree(screen: TopicsScreen) -> None:
    screen.toggle_picture()


@action(
    "topics.endpoints",
    "I",
    N_("Endpoints"),
    N_("Show every publisher and subscriber with its QoS, and which of them are incompatible."),
    means="nodes behind it",
    footer=True,
    anywhere=True,
    when=_shows_table,
    label=lambda screen: N_("Message") if screen.detail.as_endpoints else N_("Endpoints"),
)
def show_endpoints(screen: TopicsScreen) -> None:
    screen.toggle_endpoints()


@action(
    "topics.sort",
    "greater_than_sign,Ю",
    N_("Sort"),
    N_("Sort by the next column; a click on a title sorts by that one."),
    footer=True,
    anywhere=True,
    when=_shows_table,
)
def sort_by_next(screen: TopicsScreen) -> None:
    screen.table.sort_by_next()


@action(
    "topics.reverse",
    "less_than_sign,Б",
    N_("Reverse"),
    N_("Reverse the order of the topics."),
    anywhere=True,
    when=_shows_table,
)
def reverse_order(screen: TopicsScreen) -> None:
    order = screen.table.order
    screen.table.reorder(order.by(order.column_id))


@action(
    "topics.housekeeping",
    "a",
    N_("All"),
    N_("Show or hide topics of ROS itself: /rosout, /parameter_events."),
    means="all",
    footer=True,
    anywhere=True,
    when=_shows_table,
)
def show_housekeeping(screen: TopicsScreen) -> None:
    screen.toggle_housekeeping()


@action(
    "topics.publish",
    "P",
    N_("Publish"),
    N_("Publish a message to the selected topic or to a new one, once or at a rate."),
    footer=True,
    anywhere=True,
    when=lambda screen: screen.feed.graph is not None and screen.feed.replay is None,
)
def open_publish(screen: TopicsScreen) -> None:
    from tui.topics.publish import PublishDialog

    screen.app.push_screen(PublishDialog(screen.table.chosen_row, lambda: screen.detail.sample))


TOPICS_ACTIONS = actions_of(__name__)
