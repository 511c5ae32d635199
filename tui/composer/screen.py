"""The JSON that an LLM would send: written, checked, sent, and its outcome."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.containers import Horizontal, Vertical
from textual.events import Unmount
from textual.widgets import Static, TextArea

from graph.observer.requests import PreparePublisher, Publish
from robot.commands.schema import MAX_BYTES, CommandError, parse_llm
from robot.topics import LLM_RAW_JSON
from text import ros2_words
from text.i18n import N_, _, decimal
from text.plain import plain
from tui import clock
from tui.actions import bindings
from tui.composer.actions import COMPOSER_ACTIONS, send, send_anyway
from tui.composer.ask_line import AskLine
from tui.composer.asking import ComposerAsking
from tui.composer.json_editor import JsonEditor
from tui.composer.prompt_dialog import PromptDialog
from tui.composer.senses import WATCHED, RobotSenses
from tui.composer.sent import Sent, sent_path
from tui.composer.templates import TEMPLATES, TemplatesDialog
from tui.composer.verdict import JsonVerdict
from tui.frame.screen import DeckScreen
from tui.outcome.trail import FOLLOWED, OutcomeTrail
from tui.outcome.view import Outcome
from tui.widgets.marked_editor import TextPlace
from tui.widgets.trouble import names
from tui.yaml_form.words import reason_words

if TYPE_CHECKING:
    from concurrent.futures import Future

    from textual.app import ComposeResult
    from textual.timer import Timer

    from graph.data import Sample, TopicRow
    from robot.commands.schema import LlmResponse, Problem
    from tui.composer.question import ModelAnswer
    from tui.emergency.messages import EmergencyChanged
    from tui.session.messages import GraphChanged, LanguageChanged, SessionChanged

TYPE = "std_msgs/msg/String"
CHECKED_AFTER_S = 0.15
SENT_WITHIN_S = 3.0
PROGRESS_S = 0.1
"""How often an answer that comes is drawn."""
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
        self._response: LlmResponse | None = None
        self._trail: OutcomeTrail | None = None
        self._newest: dict[str, Sample] = {}
        self._listener: TopicRow | None = None
        self._checking: Timer | None = None
        self.senses = RobotSenses()
        self.asking = ComposerAsking(self)

    def compose_body(self) -> ComposeResult:
        with Horizontal(id="composer-body"):
            with Vertical(id="composer-left"):
                yield Static(id="composer-to", classes="composer-title", markup=False)
                yield JsonEditor(TEMPLATES[0].text())
                yield JsonVerdict()
                yield AskLine()
            with Vertical(id="composer-right"):
                yield Static(id="composer-came", classes="composer-title", markup=False)
                yield Outcome()

    @property
    def editor(self) -> JsonEditor:
        return self.query_one(JsonEditor)

    @property
    def verdict(self) -> JsonVerdict:
        return self.query_one(JsonVerdict)

    @property
    def outcome(self) -> Outcome:
        return self.query_one(Outcome)

    @property
    def line(self) -> AskLine:
        return self.query_one(AskLine)

    @property
    def is_writing(self) -> bool:
        """Whether the cursor stands in a text field."""
        return self.focused in (self.editor, self.line.field)

    @property
    def send_key(self) -> str:
        return self.deck.keys_of(send)[0]

    @property
    def is_asking(self) -> bool:
        """Whether an answer of a model is under way."""
        return self.asking.under_way

    @property
    def is_auto(self) -> bool:
        """Whether a valid answer is sent by itself."""
        return self.asking.auto

    @property
    def problems(self) -> tuple[Problem, ...]:
        return self.verdict.problems if self.is_mounted else ()

    def follow_topics(self) -> set[str]:
        """All topics that a message may affect, while this screen is in front or one is recent."""
        tracing = self._trail is not None and not self._trail.over(clock.now())
        return set(FOLLOWED) if tracing or self.is_current else set()

    def watch_topics(self) -> set[str]:
        """What a model gets to know of the robot."""
        return set(WATCHED)

    def on_mount(self) -> None:
        # The cursor is nowhere, so that each key does what the top line says.
        self.check()
        self.line.show_mark(auto=False)
        self.set_interval(PROGRESS_S, self.asking.show_progress)
        self.set_interval(BUDGET_S, self._show_budget)
        self._say()

    @on(Unmount)
    async def _hang_up(self) -> None:
        self.asking.end()
        await self.asking.models.close()

    def on_screen_resume(self) -> None:
        """Prepare the publisher, so that the first message goes out at once."""
        self.asking.read_settings()
        if self.feed.graph is not None:
            self.feed.graph.ask(PreparePublisher(LLM_RAW_JSON, TYPE))

    def on_session_changed(self, message: SessionChanged) -> None:
        """Forget everything of the previous session."""
        del message
        self._trail, self._listener = None, None
        self._newest.clear()
        self.senses = RobotSenses()
        self.asking.session_changed()
        if self.is_current and self.feed.graph is not None:
            self.feed.graph.ask(PreparePublisher(LLM_RAW_JSON, TYPE))
        self._say()

    def on_graph_changed(self, message: GraphChanged) -> None:
        update = message.update
        self._listener = next((row for row in update.topics if row.name == LLM_RAW_JSON), None)
        if self._trail is not None and not self._trail.over(clock.now()):
            self._trail.see(update.samples)
        self.senses.see(update.samples)
        for topic in FOLLOWED & update.samples.keys():
            self._newest[topic] = update.samples[topic][-1]
        self._say()

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self.verdict.relabel()
        self.asking.read_settings()
        self.asking_changed()
        self._say()

    def on_emergency_changed(self, message: EmergencyChanged) -> None:
        """Send nothing by itself any more."""
        if message.emergency.engaged:
            self.asking.stopped()

    @on(AskLine.Asked)
    def _asked(self, message: AskLine.Asked) -> None:
        self.asking.ask(message.words)

    def asking_changed(self) -> None:
        """Show whether a model is asked, and whether its answers are sent by themselves."""
        self.line.show_mark(auto=self.is_auto)
        self.refresh_bindings()

    def _show_budget(self) -> None:
        if self.is_current:
            self.asking.show_status()

    @on(TextArea.Changed)
    def _text_changed(self) -> None:
        if self._checking is not None:
            self._checking.stop()
        self._checking = self.set_timer(CHECKED_AFTER_S, self.check)

    @on(JsonEditor.TooLong)
    def _too_long(self) -> None:
        words = _("Not pasted: {limit} bytes at most.").format(limit=MAX_BYTES)
        self.notify(words, severity="warning", markup=False)

    @on(JsonVerdict.ProblemWanted)
    def _wanted(self, message: JsonVerdict.ProblemWanted) -> None:
        self.editor.go_to(message.place)

    def check(self) -> None:
        """Check the JSON, and show the problems; not of an answer that still comes."""
        if self.is_asking:
            self._response = None
            return
        problems: tuple[Problem, ...] = ()
        try:
            self._response = parse_llm(self.editor.text)
        except CommandError as error:
            self._response, problems = None, error.problems
        had = self.problems
        self.verdict.show(problems, len(self._response.commands) if self._response else 0)
        self.editor.show_problems(TextPlace(problem.line, problem.column) for problem in problems)
        if bool(had) != bool(problems):
            self.refresh_bindings()

    def send(self, *, anyway: bool = False) -> bool:
        """Send the JSON, invalid JSON only with `anyway`; return whether it went out."""
        if self.is_asking:
            return False
        self.check()
        if self.problems and not anyway:
            self.go_to_next_problem()
            words = _("Not sent: there are problems. {key} sends it anyway.").format(
                key=self.deck.keys_of(send_anyway)[0]
            )
            self.notify(words, severity="warning", markup=False)
            return False
        graph = self.feed.graph
        if graph is None:
            words = _("Not sent: no lesson is running.")
            self.notify(words, severity="warning", markup=False)
            return False
        text = self.editor.text
        self._sent.add(text)
        self._trail = OutcomeTrail(clock.now(), self._listeners(), self._response, self._newest)
        self.topics_changed()
        future = graph.ask(Publish(LLM_RAW_JSON, TYPE, {"data": text}))
        # Not awaited here: further keys wait until the action of a key has finished.
        self.run_worker(self._confirm(self._trail, future), group="send")
        self.asking.note_sent(text)
        self._say()
        return True

    async def _confirm(self, trail: OutcomeTrail, future: Future[int]) -> None:
        try:
            await asyncio.wait_for(asyncio.wrap_future(future), SENT_WITHIN_S)
        except asyncio.TimeoutError:
            trail.failure = _("ROS did not accept it within {n} s").format(n=decimal(f"{SENT_WITHIN_S:g}"))
        except Exception as error:  # noqa: BLE001 - any failure is reported
            trail.failure = reason_words(error)
        if trail.failure:
            self.asking.end_auto()
            self._say()

    async def ros2_command(self) -> str:
        """Return what publishes the text once."""
        return ros2_words.pub(LLM_RAW_JSON, TYPE, {"data": self.editor.text})

    def write(self) -> None:
        """Put the cursor into the JSON."""
        self.editor.focus()

    def leave(self) -> None:
        """Take the cursor out of the text field."""
        self.set_focus(None)

    def choose_template(self) -> None:
        """Ask for an example, and replace the text with it."""

        def take(text: str | None) -> None:
            if text is not None:
                self.editor.replace_all(text)
            self.editor.focus()

        self.app.push_screen(TemplatesDialog(), take)

    def go_to_line(self) -> None:
        """Go to the line in which a model is asked."""
        self.line.field.focus()

    def toggle_auto(self) -> None:
        """Send valid answers by themselves from now on, or no longer."""
        self.asking.toggle_auto()

    def stop_asking(self) -> None:
        self.asking.cancel()

    def compare(self) -> None:
        """Ask two models the same words, and take what a person chooses."""
        dialog = self.asking.comparison()

        def take(answer: ModelAnswer | None) -> None:
            if answer is not None:
                self.asking.answer = answer
                self.editor.replace_all(answer.text)
                self.check()
                self.editor.focus()
            self.asking.show_status()

        if dialog is not None:
            self.app.push_screen(dialog, take)

    def show_prompt(self) -> None:
        self.app.push_screen(PromptDialog(self.asking.models))

    def recall(self, *, older: bool) -> None:
        """Replace the text with the one sent before it, or after it."""
        text = self._sent.older(self.editor.text) if older else self._sent.newer()
        if text is None:
            self.app.bell()
            return
        self.editor.replace_all(text)

    def go_to_next_problem(self) -> None:
        """Move the cursor to the next problem, or from the last one to the first."""
        if not self.problems:
            return
        row, column = self.editor.cursor_location
        places = sorted(TextPlace(problem.line, problem.column) for problem in self.problems)
        here = TextPlace(row + 1, column + 1)
        self.editor.go_to(next((place for place in places if place > here), places[0]))

    def _listeners(self) -> list[str]:
        row = self._listener
        if row is None or not row.subscribers:
            return []
        return [names(row.subscribed_by) or str(row.subscribers)]

    def _say(self) -> None:
        if not self.is_mounted:
            return
        listening = ", ".join(self._listeners()) or _("nobody listens")
        self._title("#composer-to", f"{LLM_RAW_JSON} → {listening}")
        self._title("#composer-came", _("What happened"))
        trail, now_s = self._trail, clock.now()
        if trail is None:
            hint = _("{key} sends the JSON to llm_parser.").format(key=self.deck.keys_of(send)[0])
            if self.feed.replay is not None:
                hint = _("This is a recording: there is nobody to send to.")
            nothing = _("Nothing has been sent yet.")
            self.outcome.show(f"{nothing} {hint}", ())
            return
        at = clock.time_of_day(trail.sent_s)
        self.outcome.show(_("Sent at {time}").format(time=at), trail.entries(now_s))

    def _title(self, selector: str, words: str) -> None:
        title = self.query_one(selector, Static)
        if title.content != words:
            title.update(plain(words))
