"""An expression above the echo: only messages that match it are shown, and all are counted."""

from __future__ import annotations

from collections.abc import Iterable

from textual import getters, on
from textual.app import ComposeResult
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Input, Static

from graph.data import Sample
from graph.messages.condition import LONGEST, ConditionError, MessageFilter
from text.i18n import _, localized, ngettext
from text.plain import plain
from tui.widgets.field import Field

LONGEST_WORDS = 200


class EchoFilter(Horizontal):
    """A field that is visible once it has been requested; each topic has its own expression."""

    class ExpressionChanged(Message):
        """Another expression is in use, or none."""

    DEFAULT_CSS = """
    EchoFilter {
        height: auto; width: 1fr; background: $panel; display: none;
        &.-open { display: block; }
        Static { width: auto; height: 1; color: $text-muted; }
        Field { width: 1fr; min-width: 16; margin: 0 1; }
        .filter-told { max-width: 60%; height: auto; max-height: 2; color: $text-success; }
        &.-wrong .filter-told { color: $text-error; text-style: bold; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._topic = ""
        self._texts: dict[str, str] = {}
        """Maps a topic to its expression."""
        self._condition: MessageFilter | None = None
        self._error: ConditionError | None = None
        """What is wrong with the expression, or with its evaluation on the newest message."""
        self._seen = self._fitted = self._failed = 0
        self._sent_s: float | None = None
        """When the newest message examined was sent."""

    def compose(self) -> ComposeResult:
        yield Static(classes="filter-label", markup=False)
        yield Field(id="echo-filter", compact=True, select_on_focus=False, max_length=LONGEST)
        yield Static(classes="filter-told", markup=False)

    def on_mount(self) -> None:
        self.on_language_changed()

    field = getters.query_one(Field)

    @property
    def in_force(self) -> bool:
        return bool(self._texts.get(self._topic, "").strip())

    @property
    def is_wrong(self) -> bool:
        return self.in_force and self._condition is None

    def open(self) -> None:
        self.add_class("-open")
        self.field.focus()

    def close(self) -> None:
        self.field.value = ""
        self.remove_class("-open")

    def show_topic(self, topic: str) -> None:
        if topic == self._topic:
            return
        self._topic = topic
        with self.prevent(Input.Changed):
            self.field.value = self._texts.get(topic, "")
        self._take()
        self.set_class(self.in_force, "-open")

    def fitting(self, samples: Iterable[Sample]) -> Sample | None:
        """Count these messages of the topic; return the newest that matches, if there is one."""
        found = None
        for sample in samples:
            if not self.in_force:
                found = sample
            elif sample.sent_s is None or sample.sent_s != self._sent_s:
                # A new subscription receives the newest message a second time.
                self._sent_s = sample.sent_s
                found = sample if self._fits(sample) else found
        if self.in_force:
            self._tell()
        return found

    def on_language_changed(self) -> None:
        self.query_one(".filter-label", Static).update(" " + _("only if"))
        self.field.placeholder = _("an expression on the message m, such as m.data > 0.5")
        self._tell()

    def why_none(self) -> tuple[str, str]:
        """Return headline and detail for the place of a message while none matches."""
        if self.is_wrong:
            return _("the expression is wrong"), _("Nothing is shown until it is right.")
        return _("no message matches the expression yet"), self._counts()

    @on(Input.Changed)
    def _typed(self, event: Input.Changed) -> None:
        event.stop()
        self._texts[self._topic] = event.value
        self._take()
        self.post_message(self.ExpressionChanged())

    def _take(self) -> None:
        self._condition = self._error = None
        self._seen = self._fitted = self._failed = 0
        self._sent_s = None
        if self.in_force:
            try:
                self._condition = MessageFilter(self._texts[self._topic])
            except ConditionError as error:
                self._error = error
        self._tell()

    def _fits(self, sample: Sample) -> bool:
        if self._condition is None:
            return False
        self._seen += 1
        try:
            fits = self._condition.holds(sample.value)
        except ConditionError as error:
            self._error, fits = error, False
            self._failed += 1
        self._fitted += fits
        return fits

    def _counts(self) -> str:
        words = ngettext("{fit} of {n} message", "{fit} of {n} messages", self._seen)
        return words.format(fit=self._fitted, n=self._seen)

    def _tell(self) -> None:
        """Show how many match, and report an error only once, however many messages cause it."""
        parts = [] if self._condition is None else [self._counts()]
        if self._error is not None:
            times = f" (×{self._failed})" if self._failed else ""
            parts.append("✗ " + plain(localized(self._error.words), LONGEST_WORDS) + times)
        words = " · ".join(parts)
        self.set_class(self._error is not None, "-wrong")
        told = self.query_one(".filter-told", Static)
        if told.content != words:
            told.update(words)
