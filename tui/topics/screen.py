"""Every topic with its rates, and a live view of the chosen one."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

from textual import getters, on
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.timer import Timer
from textual.widgets import Input, Static

from graph.data import Sample, TopicRow
from graph.housekeeping import is_housekeeping
from graph.qos import to_hear
from text import ros2_words
from text.i18n import N_, _, ngettext
from tui.actions import bindings
from tui.echo.tree import EchoTree
from tui.frame.screen import DeckScreen
from tui.session.messages import GraphChanged, LanguageChanged, SessionChanged
from tui.topics.actions import TOPICS_ACTIONS
from tui.topics.detail import TopicDetail, carries_images, is_image
from tui.topics.echo_filter import EchoFilter
from tui.topics.plot import NAMES, TopicPlot
from tui.topics.plot_history import PlotField
from tui.topics.table import TopicsTable, why_empty
from tui.widgets.field import Field

SETTLED_S = 0.12
"""How long a choice must stand before its topic is subscribed, so that moving through the list
with the arrow keys subscribes to none of the topics passed by."""
STEADY_S, LIVELY_S = 0.25, 0.1
"""Seconds between two updates, without and with a picture in front."""
RATES_S = 0.2
"""Minimum time between two updates of the rates."""


class TopicsScreen(DeckScreen):
    """A table of topics and, for the chosen one, the newest message as a tree or a picture."""

    tab: ClassVar[str] = "topics"
    parts: ClassVar[tuple[str, ...]] = ("TopicPlot", "TopicDetail")
    about: ClassVar[str] = N_(
        "Every topic of the robot with its type, who publishes and who listens, its rate and "
        "bandwidth, and how old its newest message is. The selected one is shown live below or "
        "beside: as a tree that folds, an image as a picture. Where nothing comes, it says why."
    )
    measure_all = True
    AUTO_FOCUS: ClassVar[str] = "TopicsTable"
    BINDINGS: ClassVar = bindings(*TOPICS_ACTIONS)
    DEFAULT_CSS = """
    TopicsScreen TopicPlot { display: none; border-top: solid $panel; }
    TopicsScreen.-plot {
        TopicPlot { display: block; height: 4fr; }
        TopicDetail { height: 3fr; }
        TopicsTable { max-height: 25%; }
    }
    TopicsScreen {
        #topics-bar { height: 1; }
        #topics-filter { width: 1fr; }
        #topics-count { width: auto; padding: 0 1; color: $text-muted; }
        #topics-body { height: 1fr; layout: vertical; }
        TopicsTable { height: auto; min-height: 4; max-height: 50%; }
        TopicDetail { border-top: solid $panel; }
    }
    TopicsScreen.-wide {
        #topics-body { layout: horizontal; }
        TopicsTable { width: 2fr; height: 1fr; max-height: 100%; }
        TopicDetail { width: 1fr; border-top: none; border-left: solid $panel; }
    }
    TopicsScreen.-flat TopicDetail { border-top: none; }
    TopicsScreen TopicDetail.-maximized, TopicsScreen TopicPlot.-maximized {
        border: none !important;
    }
    TopicsScreen.-low.-plot, TopicsScreen.-flat.-plot {
        TopicPlot { height: 5fr; border-top: none; background: $panel; }
        TopicsTable { max-height: 20%; }
    }
    TopicsScreen.-wide.-plot {
        #topics-body { layout: grid; grid-size: 2; grid-columns: 2fr 1fr; grid-rows: 1fr 1fr; }
        TopicsTable { width: 1fr; height: 1fr; max-height: 100%; }
        TopicDetail { width: 1fr; height: 1fr; row-span: 2; }
        TopicPlot { height: 1fr; }
    }
    TopicsScreen.-plot.-plot-alone {
        #topics-body { layout: vertical; }
        TopicsTable, TopicDetail, #topics-bar { display: none; }
        TopicPlot { height: 1fr; border-top: none; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self.table: TopicsTable = TopicsTable()
        self.detail: TopicDetail = TopicDetail()
        self.plot: TopicPlot = TopicPlot()
        self._rates_s = 0.0
        self._settling: Timer | None = None
        self._offered_with_message = False
        """Whether the keys were last updated with a message on the screen."""
        self._listed: tuple[TopicRow, ...] = ()
        self._missed: Sample | None = None
        """What would have been shown while another screen was in front."""

    def compose_body(self) -> ComposeResult:
        with Horizontal(id="topics-bar"):
            yield Field(id="topics-filter", compact=True, select_on_focus=False)
            yield Static(id="topics-count", markup=False)
        with Vertical(id="topics-body"):
            yield self.table
            yield self.detail
            yield self.plot

    filter: getters.query_one[Input] = getters.query_one("#topics-filter", Input)

    def watch_topics(self) -> set[str]:
        """The chosen topic; of one with images only its messages as a tree."""
        if not self.table.chosen or (self.shows_image and not self._shows_tree):
            return set()
        return {self.table.chosen}

    def picture_topics(self) -> set[str]:
        """The chosen topic if it is one with images, unless they are shown as a tree."""
        hidden = self.detail.as_endpoints or self._shows_tree or not self.shows_image
        return set() if hidden or not self.table.chosen else {self.table.chosen}

    @property
    def _shows_tree(self) -> bool:
        """Whether a message is shown as a tree; the first of a topic may become a picture."""
        detail = self.detail
        return not (detail.as_endpoints or detail.as_picture or detail.sample is None)

    def follow_topics(self) -> set[str]:
        """Plotted topics, and the chosen one while an expression examines each message."""
        followed = self.plot.topics
        if self.table.chosen and self.detail.filter.in_force:
            return {*followed, self.table.chosen}
        return followed

    def on_mount(self) -> None:
        self.table.focus()
        self._label()

    def on_graph_changed(self, message: GraphChanged) -> None:
        update = message.update
        self.plot.take(update)
        samples = update.samples.get(self.table.chosen, ())
        self._missed = self.detail.fitting(samples) or self._missed
        if self.feed.front is not self:
            return
        if self._is_time_for_rates(update.time_s):
            self._listed = tuple(row for row in update.topics if self._is_listed(row))
            self.table.show_topics(self._listed)
            self.detail.show_topic(self.table.chosen_row)
            self._count()
        if not self.table.shown:
            self._say_why_empty()
        missed, self._missed = self._missed, None
        if missed is not None and missed.topic == self.table.chosen:
            self._show_message(missed)
        if self._offered_with_message is not self.has_message:
            self._offered_with_message = self.has_message
            self.refresh_bindings()

    def on_session_changed(self, message: SessionChanged) -> None:
        del message
        if self.feed.link is None:
            self._listed = ()
            self.table.show_topics(())
            self.plot.clear()
            self._label()

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self._label()

    @on(TopicsTable.Highlighted)
    def _chosen(self) -> None:
        self.detail.show_topic(self.table.chosen_row)
        self.detail.echo.mark(self.plot.marks(self.table.chosen))
        self._keep_pace()
        self._offered_with_message = self.has_message
        self.refresh_bindings()
        if self._settling is not None:
            self._settling.stop()
        self._settling = self.set_timer(SETTLED_S, self.topics_changed)

    @property
    def has_message(self) -> bool:
        """Whether a message of the chosen topic is shown, possibly paused."""
        return self.detail.echo.message is not None

    @on(EchoFilter.ExpressionChanged)
    def _expression_changed(self) -> None:
        found = self.detail.filter_anew()
        if found is not None:
            self._show_message(found)
        self.topics_changed()

    @on(Input.Submitted, "#echo-filter")
    def _expression_done(self) -> None:
        self.detail.echo.focus()

    @on(TopicsTable.Opened)
    def _opened(self) -> None:
        front = self.detail.front
        (front if front.can_focus else self.detail.echo).focus()

    @on(TopicsTable.Arranged)
    def _arranged(self) -> None:
        self._count()

    @on(EchoTree.PauseChanged)
    def _pause_changed(self) -> None:
        self.detail.say()
        self._keep_pace()
        self.refresh_bindings()

    @on(TopicPlot.PlotChanged)
    def _plot_changed(self) -> None:
        if not self.plot.has_value:
            self.show_plot("none")
        self.detail.echo.mark(self.plot.marks(self.table.chosen))
        self.refresh_bindings()
        self.topics_changed()

    @on(Input.Changed, "#topics-filter")
    def _filter_changed(self, event: Input.Changed) -> None:
        self.table.filter(event.value)

    @on(Input.Submitted, "#topics-filter")
    def _filter_done(self) -> None:
        self.table.focus()

    def key_escape(self) -> None:
        """Leave the filter and show every topic again, or leave the message or the plot."""
        if self.plot_covers_all:
            self.show_plot("beside")
        if self.focused in (self.filter, self.table):
            self.filter.value = ""
        if self.focused is self.detail.filter.field:
            self.detail.filter.close()
        self.table.focus()

    # Actions

    def show_topic(self, topic: str) -> None:
        """Choose a topic, even if a filter or an option hides it."""
        self.filter.value = ""
        self.table.filter("")
        if is_housekeeping(topic) and not self.table.order.housekeeping:
            self.toggle_housekeeping()
        # A screen that was just created has to receive its topics first.
        self.call_later(self.table.choose, topic)

    def toggle_housekeeping(self) -> None:
        order = self.table.order
        self.table.reorder(replace(order, housekeeping=not order.housekeeping))

    def toggle_endpoints(self) -> None:
        self.detail.show_as_endpoints(not self.detail.as_endpoints)
        self._keep_pace()
        self.topics_changed()
        self.refresh_bindings()

    @property
    def shows_image(self) -> bool:
        return carries_images(self.table.chosen_row)

    def toggle_picture(self) -> None:
        if self.detail.as_endpoints:
            self.detail.show_as_endpoints(False)
        else:
            self.detail.show_as_picture(not self.detail.as_picture)
        self._keep_pace()
        self.topics_changed()

    @property
    def plot_place(self) -> str:
        """`none`, `beside` (below the message or the table) or `alone`; the style sheet goes by the classes."""
        if not self.has_class("-plot"):
            return "none"
        return "alone" if self.has_class("-plot-alone") else "beside"

    @property
    def plot_covers_all(self) -> bool:
        return self.plot_place == "alone"

    def show_plot(self, place: str) -> None:
        self.set_class(place != "none", "-plot")
        self.set_class(place == "alone", "-plot-alone")
        if place != "alone" and self.focused is None:
            self.table.focus()
        self.refresh_bindings()
        self._keep_pace()

    def toggle_field(self) -> None:
        echo = self.detail.echo
        field = PlotField(self.table.chosen, echo.at_cursor or ())
        refusal = ""
        if not field.topic or not field.path or echo.message is None or field.number(echo.message) is None:
            refusal = _("Put the cursor on a number first: Tab goes to the message.")
        elif len(self.plot.fields) >= len(NAMES) and field not in self.plot.fields:
            refusal = _("There is no room for more fields: remove one first.")
        if refusal:
            self.notify(refusal, severity="warning", markup=False)
        elif self.plot.toggle(field, self.detail.sample) and self.plot_place == "none":
            self.show_plot("beside")

    @property
    def paused(self) -> bool:
        return self.detail.echo.paused or (self.plot.paused and self.plot_place != "none")

    def toggle_pause(self) -> None:
        paused = not self.paused
        self.detail.echo.pause(paused)
        self.plot.pause(paused and self.plot_place != "none")

    async def ros2_command(self) -> str:
        row = self.table.chosen_row
        if row is None:
            return ros2_words.echo(self.table.chosen) if self.table.chosen else ""
        qos = to_hear(row.published_by)
        echo = self.detail.echo
        path = echo.at_cursor or () if echo.has_focus else ()
        return ros2_words.echo(row.name, path, reliability=qos.reliability, durability=qos.durability)

    # Display

    def _show_message(self, sample: Sample) -> None:
        first = self.detail.sample is None
        self.detail.show_message(sample)
        if is_image(sample):
            if first:
                self.detail.show_as_picture(True)
            if self._shows_picture:
                topic = sample.topic
                self.detail.show_picture(
                    sample, lambda: self.is_attached and topic == self.table.chosen and self._shows_picture
                )
        if first:
            self._keep_pace()

    @property
    def _shows_picture(self) -> bool:
        in_front = self.detail.front is self.detail.picture and not self.plot_covers_all
        return in_front and not self.detail.echo.paused

    def _keep_pace(self) -> None:
        period_s = LIVELY_S if self._shows_picture else STEADY_S
        if period_s != self.period_s:
            self.period_s = period_s
            self.topics_changed()

    def _is_time_for_rates(self, time_s: float) -> bool:
        """Return whether to update the rates now; pictures come more often than those change."""
        if self.period_s == LIVELY_S and 0 <= time_s - self._rates_s < RATES_S:
            return False
        self._rates_s = time_s
        return True

    def _is_listed(self, row: TopicRow) -> bool:
        """Hide topics that only Deck uses; the chosen one stays even if everybody has left it."""
        return bool(row.publishers or row.subscribers) or row.name == self.table.chosen

    def _label(self) -> None:
        self.filter.placeholder = _("filter: words of a name or a type")
        self._say_why_empty()
        self._count()

    def _say_why_empty(self) -> None:
        topics = () if self.feed.update is None else self.feed.update.topics
        self.table.show_words(*why_empty(self.deck, tuple(filter(self._is_listed, topics))))

    def _count(self) -> None:
        everything = len(self._listed)
        shown = len(self.table.shown)
        words = ngettext("{n} topic", "{n} topics", everything)
        if shown != everything:
            words = ngettext("{shown} of {n} topic", "{shown} of {n} topics", everything)
        words = words.format(shown=shown, n=everything)
        count = self.query_one("#topics-count", Static)
        if words != getattr(count, "content", None):
            count.update(words)
