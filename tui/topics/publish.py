"""The dialog that publishes a message: its destination, its text as a form, its rate, and what is going on."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import TYPE_CHECKING, ClassVar

from rich.cells import cell_len
from textual import getters, on, work
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.widgets import Input, Static

from graph.data import Publication, Sample, TopicRow, Value
from graph.messages.browse import interfaces
from graph.messages.yaml_form import filled
from graph.messages.yaml_text import is_cut
from graph.observer.requests import Publish, StartPublishing, StopPublishing
from graph.publishing.outbox import LEAST_HZ, MOST_HZ
from text import ros2_words
from text.i18n import N_, _, decimal, localized, ngettext
from text.plain import plain
from text.ros_names import TOPIC_NAME
from tui.actions import bindings
from tui.dialogs.dialog import Dialog
from tui.dialogs.ros2 import copy_dialog_as_ros2
from tui.frame import title
from tui.frame.actions.app import emergency_stop
from tui.frame.key_bar import KeyBar
from tui.frame.title_bar import TitleBar
from tui.panels.panel import row_of
from tui.topics.actions_of_publish import PUBLISH_ACTIONS
from tui.widgets.field import Field
from tui.widgets.rows import Cell, Column, Row, Rows
from tui.yaml_form.form import YamlForm
from tui.yaml_form.type_field import TypeField
from tui.yaml_form.words import reason_words

if TYPE_CHECKING:
    from tui.session.ports import GraphLink


LONGEST = 300
MOST_LINES = 5
LOOK_S = 0.25
DONE_WITHIN_S = 8.0
"""Time limit; a new publisher may wait four seconds for its subscribers."""
LONGEST_ARRAY = 1000


class PublishDialog(Dialog[None]):
    """Topic, type and form; below them a rate, and what is being published now."""

    BINDINGS: ClassVar = bindings(*PUBLISH_ACTIONS, copy_dialog_as_ros2)
    DEFAULT_CSS: ClassVar[str] = """
    PublishDialog {
        align: center top; background: $background;
        TitleBar { dock: top; }
        #dialog { width: 120; height: 1fr; max-height: 100%; padding: 0 1; }
        .row { height: auto; }
        .label { width: 8; color: $text-muted; }
        #target-topic { width: 1fr; }
        YamlForm { border-top: solid $panel; border-bottom: solid $panel; }
        #rate-hz { width: 8; }
        #rate-unit { width: auto; padding: 0 2 0 0; color: $text-muted; }
        #rate-said { width: 1fr; height: auto; max-height: 3; }
        #rate-said.-good { color: $text-success; }
        #rate-said.-bad { color: $text-error; text-style: bold; }
        #publications { display: none; border-top: solid $panel; }
        #publications.-some { display: block; }
    }
    """

    def __init__(self, row: TopicRow | None, sample: Callable[[], Sample | None]) -> None:
        """Start with the topic of `row`, or a new one for None; `sample` is its newest message."""
        super().__init__()
        self._row = row
        self._sample = sample
        self._listed: tuple[Publication, ...] | None = None
        self._said: tuple[Callable[[], str], str] = (lambda: "", "")
        """The remark beside the rate, in the current language, and its look."""

    def title_words(self) -> str:
        return _("Publish a message")

    def words(self) -> Content:
        return Content("")

    def compose(self) -> ComposeResult:
        yield TitleBar()
        with Vertical(id="dialog"):
            with Horizontal(classes="row"):
                yield Static(id="topic-label", classes="label", markup=False)
                yield Field(id="target-topic", compact=True, select_on_focus=False)
            with Horizontal(classes="row"):
                yield Static(id="type-label", classes="label", markup=False)
                yield TypeField()
            yield YamlForm(submits=False)
            with Horizontal(classes="row"):
                yield Static(id="rate-label", classes="label", markup=False)
                yield Field("10", id="rate-hz", compact=True, select_on_focus=False)
                yield Static(id="rate-unit", markup=False)
                yield Static(id="rate-said", markup=False)
            yield Rows(id="publications")
            yield KeyBar()

    def on_mount(self) -> None:
        # A tab would replace this screen and put its own above the topics.
        self.query_one(TitleBar).disabled = True
        self.redraw()
        self.run_worker(self._learn_types(), group="types")
        self.set_interval(LOOK_S, self._look)
        if self._row is None:
            self.topic_field.focus()
            return
        self.topic_field.value = self._row.name
        self._follow_topic()
        self.form.editor.focus()

    async def _learn_types(self) -> None:
        names = await asyncio.to_thread(interfaces)
        self.type.know(tuple(name for name in names if "/msg/" in name))

    topic_field = getters.query_one("#target-topic", Input)

    @property
    def topic(self) -> str:
        """The topic that was entered; a relative name is below the root."""
        name = self.topic_field.value.strip()
        return name if not name or name.startswith(("/", "~")) else f"/{name}"

    type = getters.query_one(TypeField)
    rate_field = getters.query_one("#rate-hz", Input)
    form = getters.query_one(YamlForm)

    @property
    def chosen_number(self) -> int | None:
        chosen = self.query_one("#publications", Rows).chosen
        return int(chosen) if self._listed and chosen else None

    def tell(self, words: Callable[[], str], look: str = "") -> None:
        """Show a remark as `good`, `bad` or neither; `words` is called again in a new language."""
        self._said = words, look
        shown = self.query_one("#rate-said", Static)
        shown.set_class(look == "good", "-good")
        shown.set_class(look == "bad", "-bad")
        shown.update(plain(words(), LONGEST))

    def _rate_hz(self) -> float | None:
        try:
            hz = float(self.rate_field.value.replace(",", "."))
        except ValueError:
            hz = 0.0
        if LEAST_HZ <= hz <= MOST_HZ:
            return hz
        self.tell(_limits, "bad")
        self.rate_field.focus()
        return None

    @property
    def is_publishing(self) -> bool:
        return bool(self._listed)

    @property
    def newest(self) -> Sample | None:
        """The newest message of the topic that was entered, if it is the chosen one."""
        sample = self._sample()
        if sample is None or not self.is_mounted:
            return None
        return sample if sample.topic == self.topic else None

    def redraw(self) -> None:
        labels = {"topic-label": _("Topic"), "type-label": _("Type"), "rate-label": _("Rate"), "rate-unit": _("Hz")}
        for name, words in labels.items():
            self.query_one(f"#{name}", Static).update(words)
        self.topic_field.placeholder = _("/name of an existing or a new topic")
        self.type.field.placeholder = _("words of its name: float32, twist")
        self.tell(*self._said)
        dialog = self.query_one("#dialog")
        dialog.border_title = Content(self.title_words())
        stop = f"{self.deck.keys_of(emergency_stop)[-1]} {_(emergency_stop.title)}"
        dialog.border_subtitle = Content(stop)
        self._listed = None
        self._look()

    async def ros2_command(self) -> str:
        value = self.form.value
        if value is None or TOPIC_NAME.fullmatch(self.topic) is None:
            return ""
        rates = [one.hz for one in self._listed or () if one.topic == self.topic]
        hz = rates[0] if rates else None
        return ros2_words.pub(self.topic, self.form.type_name, value, hz)

    @work(group="publish")
    async def publish_once(self) -> None:
        ready = self._ready()
        if ready is None:
            return
        graph, topic, value = ready
        self.tell(lambda: _("Publishing…"))
        heard = await self._outcome(graph.ask(Publish(topic, self.form.type_name, value)))
        if heard:
            self.tell(lambda: _got(heard), "good")
        elif heard is not None:
            self.tell(lambda: _("Sent, but nobody listens to {topic}.").format(topic=topic))

    @work(group="publish")
    async def publish_at_rate(self) -> None:
        """Publish the message periodically, replacing an earlier publication on the same topic."""
        hz = self._rate_hz()
        ready = None if hz is None else self._ready()
        if hz is None or ready is None:
            return
        graph, topic, value = ready
        before = [one.number for one in self._listed or () if one.topic == topic]
        if await self._outcome(graph.ask(StartPublishing(topic, self.form.type_name, value, hz))) is None:
            return
        for number in before:
            graph.ask(StopPublishing(number))
        words = N_("Publishing to {topic} at {hz} Hz.")
        self.tell(lambda: _(words).format(topic=topic, hz=decimal(f"{hz:g}")), "good")
        self._look()

    def stop_chosen(self) -> None:
        number = self.chosen_number
        graph = self.deck.feed.graph
        if number is None or graph is None:
            return
        stopped = next((one.topic for one in self._listed or () if one.number == number), "")
        graph.ask(StopPublishing(number))
        self.tell(lambda: _("Stopped: {topic}").format(topic=stopped))

    def take_message(self) -> None:
        sample = self.newest
        if sample is None:
            return
        text = filled(sample.type_name, sample.value, most=LONGEST_ARRAY)
        self.type.set(sample.type_name)
        self.form.load(sample.type_name, text)
        if is_cut(sample.value, LONGEST_ARRAY):
            self.tell(lambda: _("Its long arrays were cut: see the remarks."))
        else:
            self.tell(lambda: _("Filled in from the newest message."))

    def leave(self) -> None:
        """Close the list of types if it is open, otherwise the dialog."""
        if self.type.is_listing:
            self.type.close()
        else:
            self.dismiss(None)

    @on(Input.Changed, "#target-topic")
    def _follow_topic(self) -> None:
        update = self.deck.feed.update
        row = None if update is None else row_of(update, self.topic)
        if row is not None and row.type_names and row.type_names[0] != self.form.type_name:
            self.type.set(row.type_names[0])
            self.form.load(row.type_names[0])
        self.refresh_bindings()

    @on(Input.Submitted, "#target-topic")
    def _topic_done(self) -> None:
        (self.form.editor if self.form.type_name else self.type.field).focus()

    @on(Input.Submitted, "#rate-hz")
    def _rate_done(self) -> None:
        self.publish_at_rate()

    @on(TypeField.TypeChosen)
    def _type_chosen(self) -> None:
        if self.type.value != self.form.type_name:
            self.form.load(self.type.value)
        if self.type.field.has_focus:
            self.form.editor.focus()

    @on(Rows.Opened, "#publications")
    def _publication_opened(self) -> None:
        self.stop_chosen()

    @on(YamlForm.Checked)
    def _checked(self) -> None:
        if self.form.error is None and self._said[1] == "bad":
            self.tell(lambda: "")

    async def _outcome(self, future: Future[int]) -> int | None:
        """Wait for the result; if there is none, say why."""
        try:
            return await asyncio.wait_for(asyncio.wrap_future(future), DONE_WITHIN_S)
        except Exception as error:  # noqa: BLE001 - any failure is reported
            reason = reason_words(error)
            self.tell(lambda: _("Not sent: {reason}").format(reason=reason), "bad")
        return None

    def _ready(self) -> tuple[GraphLink, str, Mapping[str, Value]] | None:
        graph = self.deck.feed.graph
        topic = self.topic
        if graph is None:
            self.tell(lambda: _("Not sent: no lesson is running."), "bad")
        elif TOPIC_NAME.fullmatch(self.topic) is None:
            self.tell(lambda: _("Not a topic name: letters, digits and _ between /."), "bad")
            self.topic_field.focus()
        elif not self.form.type_name or self.type.value != self.form.type_name:
            self.tell(lambda: _("Choose the type of {topic}.").format(topic=topic), "bad")
            self.type.field.focus()
        else:
            value = self.form.value
            if value is not None:
                return graph, topic, value
            self.tell(lambda: _("Not sent: the error is shown below the form."), "bad")
            self.form.go_to_problem()
        return None

    def _look(self) -> None:
        update = self.deck.feed.update
        publications = () if update is None else update.publications
        if publications != self._listed:
            had = self.is_publishing
            self._listed = publications
            columns = (
                Column(_("Publishing")),
                Column(_("Hz"), 7, right=True),
                Column(_("Sent"), max(8, cell_len(_("Sent"))), right=True),
                Column(_("Subscribers"), 11, right=True),
            )
            rows = self.query_one("#publications", Rows)
            rows.show(columns, [_row(one) for one in publications])
            rows.set_class(bool(publications), "-some")
            # The header and the line above it are in addition to the rows.
            rows.styles.height = min(MOST_LINES, len(publications)) + 2
            if had != self.is_publishing:
                self.refresh_bindings()
        title.show(self.query_one(TitleBar), self.deck, "topics")


def _got(heard: int) -> str:
    return ngettext("Sent: {n} subscriber got it.", "Sent: {n} subscribers got it.", heard).format(n=heard)


def _limits() -> str:
    limits = {"least": decimal(f"{LEAST_HZ:g}"), "greatest": f"{MOST_HZ:g}"}
    return _("The rate is {least} to {greatest} Hz.").format(**limits)


def _row(one: Publication) -> Row:
    if one.error:
        words = Cell(f"✗ {plain(one.topic, 100)}: {plain(localized(one.error), 200)}", "bad")
        return Row(str(one.number), (words,))
    heard = Cell(str(one.subscribers), "" if one.subscribers else "warn")
    cells = (Cell(plain(one.topic, 200)), Cell(decimal(f"{one.hz:g}")), Cell(str(one.sent)), heard)
    return Row(str(one.number), cells)
