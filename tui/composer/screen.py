"""The JSON that an LLM would send: written, checked, sent, and its outcome."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, ClassVar

from textual.containers import Horizontal, Vertical
from textual.widgets import Static

from graph.observer.requests import PreparePublisher, Publish
from robot.topics import LLM_RAW_JSON
from text import ros2_words
from text.i18n import N_, _
from text.plain import plain
from tui import clock
from tui.actions import bindings
from tui.composer.actions import COMPOSER_ACTIONS, send, send_anyway
from tui.composer.dialogs import TEMPLATES, PromptDialog, templates_dialog
from tui.composer.draft import Draft
from tui.composer.question import WATCHED
from tui.composer.sent import Sent, sent_path
from tui.frame.screen import DeckScreen
from tui.outcome.trail import FOLLOWED, OutcomeTrail
from tui.outcome.view import Outcome
from tui.panels.panel import row_of
from tui.widgets.trouble import listeners
from tui.yaml_form.words import reason_words

if TYPE_CHECKING:
    from concurrent.futures import Future

    from textual.app import ComposeResult

    from graph.data import Sample, TopicRow
    from robot.commands.schema import Problem
    from tui.emergency.messages import EmergencyChanged
    from tui.session.messages import GraphChanged, LanguageChanged, SessionChanged

TYPE = "std_msgs/msg/String"
SENT_WITHIN_S = 3.0
BUDGET_S = 1.0


class ComposerScreen(DeckScreen):
    """Editor and verdict beside the outcome, or above it if the screen is narrow."""

    tab: ClassVar[str] = "composer"
    parts: ClassVar[tuple[str, ...]] = ("#composer-right",)
    about: ClassVar[str] = N_(
        "The JSON that a language model would send to the robot. It is checked as you write; what "
        "is wrong is underlined and listed below with line, column and field. Sending puts it on "
        "/llm_raw_json, and the right side shows the result: accepted or refused, what went "
        "to the wheels and to the head, and after how many milliseconds. In the line below the "
        "editor you say in words what the robot should do: a language model answers with the JSON, "
        "which waits there until you send it. Enter puts the cursor into the JSON, Escape takes it "
        "out again. AUTO sends valid answers by itself; the emergency "
        "stop ends that."
    )
    period_s = 0.1
    AUTO_FOCUS: ClassVar[str] = ""
    BINDINGS: ClassVar = bindings(*COMPOSER_ACTIONS)
    DEFAULT_CSS = """
    ComposerScreen {
        #composer-body { height: 1fr; layout: horizontal; }
        #composer-left { width: 1fr; height: 1fr; }
        #composer-right { width: 1fr; height: 1fr; border-left: solid $panel; }
        #composer-right.-maximized { border-left: none; }
        .composer-title {
            height: 1; width: 1fr; background: $panel; color: $text-muted; padding: 0 1;
        }
    }
    ComposerScreen.-compact #composer-body, ComposerScreen.-tiny #composer-body {
        layout: vertical;
    }
    ComposerScreen.-compact #composer-right, ComposerScreen.-tiny #composer-right {
        border-left: none; height: 8;
    }
    ComposerScreen.-compact.-flat #composer-right, ComposerScreen.-tiny.-flat #composer-right {
        height: 30%;
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._sent = Sent(sent_path())
        self._trail: OutcomeTrail | None = None
        self._newest: dict[str, Sample] = {}
        self._listener: TopicRow | None = None
        self.draft: Draft = Draft(self.send, lambda: self.deck.keys_of(send)[0])

    def compose_body(self) -> ComposeResult:
        with Horizontal(id="composer-body"):
            yield self.draft
            with Vertical(id="composer-right"):
                yield Static(id="composer-came", classes="composer-title", markup=False)
                yield Outcome()

    @property
    def outcome(self) -> Outcome:
        return self.query_one(Outcome)

    @property
    def is_writing(self) -> bool:
        """Whether the cursor stands in a text field."""
        return self.focused in (self.draft.editor, self.draft.line.field)

    @property
    def is_asking(self) -> bool:
        """Whether an answer of a model is under way."""
        return self.draft.is_asking

    @property
    def problems(self) -> tuple[Problem, ...]:
        return self.draft.verdict.problems if self.is_mounted else ()

    def follow_topics(self) -> set[str]:
        """All topics that a message may affect, while this screen is in front or one is recent."""
        tracing = self._trail is not None and not self._trail.over(clock.now())
        return set(FOLLOWED) if tracing or self.is_current else set()

    def watch_topics(self) -> set[str]:
        """What a model gets to know of the robot."""
        return set(WATCHED)

    def on_mount(self) -> None:
        # The cursor is nowhere, so that each key does what the top line says.
        self.set_interval(BUDGET_S, self._show_budget)
        self._say()

    def on_screen_resume(self) -> None:
        """Prepare the publisher, so that the first message goes out at once."""
        self.draft.read_settings()
        self._prepare()

    def _prepare(self) -> None:
        if self.is_current and self.feed.graph is not None:
            self.feed.graph.ask(PreparePublisher(LLM_RAW_JSON, TYPE))

    def on_session_changed(self, message: SessionChanged) -> None:
        """Forget everything of the previous session."""
        del message
        self._trail, self._listener = None, None
        self._newest.clear()
        self.draft.session_changed()
        self._prepare()
        self._say()

    def on_graph_changed(self, message: GraphChanged) -> None:
        update = message.update
        self._listener = row_of(update, LLM_RAW_JSON)
        if self._trail is not None and not self._trail.over(clock.now()):
            self._trail.see(update.samples)
        self.draft.senses.see(update.samples)
        for topic in FOLLOWED & update.samples.keys():
            self._newest[topic] = update.samples[topic][-1]
        self._say()

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self._say()

    def on_emergency_changed(self, message: EmergencyChanged) -> None:
        """Send nothing by itself any more."""
        if message.emergency.engaged:
            self.draft.stopped()

    def _show_budget(self) -> None:
        if self.is_current:
            self.draft.show_status()

    def send(self, *, anyway: bool = False) -> bool:
        """Send the JSON, invalid JSON only with `anyway`; return whether it went out."""
        draft, graph = self.draft, self.feed.graph
        if draft.is_asking:
            return False
        draft.check()
        why = ""
        if self.problems and not anyway:
            draft.go_to_next_problem()
            key = self.deck.keys_of(send_anyway)[0]
            why = _("Not sent: there are problems. {key} sends it anyway.").format(key=key)
        elif graph is None:
            why = _("Not sent: no lesson is running.")
        if why or graph is None:
            self.notify(why, severity="warning", markup=False)
            return False
        text = draft.editor.text
        self._sent.keep(text)
        self._trail = OutcomeTrail(clock.now(), self._listeners(), draft.response, self._newest)
        self.topics_changed()
        future = graph.ask(Publish(LLM_RAW_JSON, TYPE, {"data": text}))
        # Not awaited here: further keys wait until the action of a key has finished.
        self.run_worker(self._confirm(self._trail, future), group="send")
        draft.note_sent(text)
        self._say()
        return True

    async def _confirm(self, trail: OutcomeTrail, future: Future[int]) -> None:
        try:
            await asyncio.wait_for(asyncio.wrap_future(future), SENT_WITHIN_S)
        except Exception as error:  # noqa: BLE001 - any failure is reported
            trail.failure = reason_words(error)
        if trail.failure:
            self.draft.end_auto()
            self._say()

    async def ros2_command(self) -> str:
        return ros2_words.pub(LLM_RAW_JSON, TYPE, {"data": self.draft.editor.text})

    def choose_template(self) -> None:
        """Ask for an example, and replace the text with it."""

        def take(chosen: str | None) -> None:
            if chosen:
                self.draft.editor.replace_all(TEMPLATES[int(chosen)].text())
            self.draft.editor.focus()

        self.app.push_screen(templates_dialog(), take)

    def show_prompt(self) -> None:
        self.app.push_screen(PromptDialog(self.draft.models))

    def recall(self, step: int) -> None:
        """Replace the text with the one sent before it (-1), or after it (1)."""
        text = self._sent.step(step, self.draft.editor.text)
        if text is None:
            self.app.bell()
        else:
            self.draft.editor.replace_all(text)

    def _listeners(self) -> list[str]:
        return listeners(self._listener)

    def _say(self) -> None:
        if not self.is_mounted:
            return
        listening = ", ".join(self._listeners()) or _("nobody listens")
        self._title("#composer-to", f"{LLM_RAW_JSON} → {listening}")
        self._title("#composer-came", _("What happened"))
        if self._trail is not None:
            at = clock.time_of_day(self._trail.sent_s)
            self.outcome.show(_("Sent at {time}").format(time=at), self._trail.entries(clock.now()))
            return
        hint = _("{key} sends the JSON to llm_parser.").format(key=self.deck.keys_of(send)[0])
        if self.feed.replay is not None:
            hint = _("This is a recording: there is nobody to send to.")
        nothing = _("Nothing has been sent yet.")
        self.outcome.show(f"{nothing} {hint}", ())

    def _title(self, selector: str, words: str) -> None:
        title = self.query_one(selector, Static)
        if title.content != words:
            title.update(plain(words))
