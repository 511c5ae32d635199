"""What is being written: the JSON with the verdict on it, and the line in which a model is asked for it.

The answer of a model grows in the editor, and waits there to be sent. In AUTO a valid answer is sent
by itself. That ends with the emergency stop, with the session, and with anything that goes wrong.
"""

from __future__ import annotations

import os
import time
from typing import TYPE_CHECKING

from textual import on
from textual.containers import Vertical
from textual.widgets import Static, TextArea

from brain.asking import AskedModels
from brain.budget import TokenUsage, summed
from brain.faults import FaultKind, ModelError
from brain.prompt import prompt_file, read_prompt
from brain.settings import load
from launcher.status import LogLine, Severity
from robot.commands.schema import MAX_BYTES, CommandError, parse_llm, so_far
from text.i18n import _, language, localized, ngettext
from text.plain import plain
from text.run_path import RUN_ID, run_folder
from tui import clock
from tui.composer.dialogs import TEMPLATES
from tui.composer.fields import AskLine, JsonEditor, JsonVerdict
from tui.composer.question import ModelQuestion, RobotSenses
from tui.frame.host import Host, host_of
from tui.outcome.model_usage import COMPOSER, budget_of, budget_words, noted, usage_of, usage_words
from tui.outcome.words import problem_words
from tui.widgets.marked_editor import TextPlace
from tui.widgets.working import Working

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.app import ComposeResult
    from textual.timer import Timer
    from textual.worker import Worker

    from brain.client import Message
    from brain.settings import ModelSettings
    from brain.thinking import Thought
    from robot.commands.schema import LlmResponse, Problem

PROMPT = "composer"
CHECKED_AFTER_S = 0.15
PROGRESS_S = 0.1
"""How often an answer that comes is drawn."""


class Draft(Vertical, Working):
    """Checks the text as it changes; asks one question at a time, and shows what comes of it."""

    def __init__(self, send: Callable[[], bool], send_key: Callable[[], str]) -> None:
        """`send` sends the JSON if it is valid, and returns whether it went out."""
        super().__init__(id="composer-left")
        self._send, self._send_key = send, send_key
        self.response: LlmResponse | None = None
        """What the JSON says, None while it is not valid."""
        self.senses = RobotSenses()
        self.models = AskedModels(COMPOSER)
        self.auto = False
        """Whether a valid answer is sent by itself."""
        self._answer: tuple[str, TokenUsage | None] | None = None
        """The last valid answer, and what all that was needed for it took."""
        self._question: ModelQuestion | None = None
        self._worker: Worker[None] | None = None
        self._checking: Timer | None = None
        self._run = ""
        self._settings: ModelSettings | None = None
        self._notes = 0

    def compose(self) -> ComposeResult:
        yield Static(id="composer-to", classes="composer-title", markup=False)
        yield JsonEditor(TEMPLATES[0].text())
        yield JsonVerdict()
        yield AskLine()

    @property
    def editor(self) -> JsonEditor:
        return self.query_one(JsonEditor)

    @property
    def verdict(self) -> JsonVerdict:
        return self.query_one(JsonVerdict)

    @property
    def line(self) -> AskLine:
        return self.query_one(AskLine)

    @property
    def is_asking(self) -> bool:
        """Whether an answer of a model is under way."""
        return self._question is not None

    @property
    def _deck(self) -> Host:
        return host_of(self)

    def on_mount(self) -> None:
        self.check()
        self.line.show_mark(auto=False)
        self.set_interval(PROGRESS_S, self._show_progress)

    async def on_unmount(self) -> None:
        """Hang up, and show nothing any more."""
        self._question = None
        if self._worker is not None:
            self._worker.cancel()
        await self.models.close()

    def on_language_changed(self) -> None:
        self.verdict.redraw()
        self.read_settings()
        self._changed()

    def _changed(self) -> None:
        """Show whether a model is asked, and whether its answers are sent by themselves."""
        self.line.show_mark(auto=self.auto)
        self.screen.refresh_bindings()

    # ---------------------------------------------------------------- the text

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
        self.response = None
        if self.is_asking:
            return
        problems: tuple[Problem, ...] = ()
        try:
            self.response = parse_llm(self.editor.text)
        except CommandError as error:
            problems = error.problems
        had = self.verdict.problems
        self.verdict.show(problems, len(self.response.commands) if self.response else 0)
        self.editor.show_problems(TextPlace(problem.line, problem.column) for problem in problems)
        if bool(had) != bool(problems):
            self.screen.refresh_bindings()

    def go_to_next_problem(self) -> None:
        """Move the cursor to the next problem, or from the last one to the first."""
        row, column = self.editor.cursor_location
        places = sorted(TextPlace(problem.line, problem.column) for problem in self.verdict.problems)
        if places:
            here = TextPlace(row + 1, column + 1)
            self.editor.go_to(next((place for place in places if place > here), places[0]))

    # ---------------------------------------------------------------- asking

    @on(AskLine.Asked)
    def _asked(self, message: AskLine.Asked) -> None:
        if self.is_asking:
            return
        words = message.words
        try:
            settings = self._settings = self.models.settings()
            prompt = read_prompt(prompt_file("", PROMPT, language()))
            situation = self.senses.situation(words)
        except ModelError as fault:
            self._show_fault(fault)
            return
        self.line.field.placeholder = _placeholder(settings)
        self.line.said.keep(words)
        self.line.show_note("")
        question = self._question = ModelQuestion(words, settings.model)
        self.editor.begin_growing()
        messages = [{"role": "system", "content": prompt}, situation.message()]
        self._worker = self.run_worker(self._ask(question, messages), group="ask")
        self._changed()
        self._show_progress()

    async def _ask(self, question: ModelQuestion, messages: list[Message]) -> None:
        try:
            thought = await self.models.ask(question.model, messages, question.pieces.append, question.repair)
        except ModelError as fault:
            if question is self._question:
                # What cannot be accepted is worth a look: it stands there with all that is wrong in it.
                self._finish(question.text if fault.kind is FaultKind.SHAPE else "")
                self._show_fault(fault)
        except Exception:
            # A mistake of Deck's own is shown elsewhere; the editor must not stay locked.
            self.cancel()
            raise
        else:
            if question is self._question:
                self._answered(question, thought)

    def cancel(self) -> None:
        """Hang up; the editor has its text again."""
        worker, self._worker = self._worker, None
        if self.is_asking:
            if worker is not None:
                worker.cancel()
            self._finish("")
            self.line.show_note(_("The question was taken back."))

    def _finish(self, text: str) -> None:
        """Put the answer into the editor; without one, what stood there."""
        self._question = None
        self.editor.end_growing(text)
        self.check()
        self._changed()
        self.show_status()

    def _answered(self, question: ModelQuestion, thought: Thought[LlmResponse]) -> None:
        self._answer = thought.text, summed(thought.usages)
        self._finish(thought.text)
        if self._deck.emergency.state.engaged:
            self.stopped()
        sent = self.auto and self._send()
        if not sent:
            self.end_auto()
        said = []
        if question.refused:
            words = _("The first answer was not valid ({problem}); the second is.")
            said.append(words.format(problem=problem_words(question.refused[0])))
        if sent:
            said.append(_("Sent by itself."))
        else:
            words = _("{send} sends the answer, {undo} brings back what stood here.")
            said.append(words.format(send=self._send_key(), undo="^z"))
        self.line.show_note(" ".join(said), "warning" if question.refused else "")
        # Whoever already writes the next question must not find the letters in the JSON.
        if self.line.field.value.strip() in ("", question.words):
            self.line.field.value = ""
            if not sent:
                self.editor.focus()

    def _show_fault(self, fault: ModelError) -> None:
        words = f"✗ {fault_words(fault)}"
        if self.auto:
            self.end_auto()
            words += " · " + _("AUTO is off.")
        self.line.show_note(words, "error")
        self.show_status()

    def note_sent(self, text: str) -> None:
        """Note in the log what an answer took that was sent as it came: Flow shows it, too."""
        if self._answer is None or self.editor.shown(self._answer[0]) != text:
            return
        # It may still say how to send it.
        self.line.show_note("")
        usage, settings = self._answer[1], self._settings
        if usage is not None and settings is not None:
            self._notes += 1
            words = noted(usage_of(usage, settings.prices))
            line = LogLine(COMPOSER, self._notes, clock.now(), Severity.INFO, words, source="deck")
            self._deck.feed.note([line])

    # ---------------------------------------------------------------- AUTO, and the session

    def toggle_auto(self) -> None:
        """Send valid answers by themselves from now on, or no longer."""
        feed = self._deck.feed
        if self.auto:
            self.end_auto()
            return
        why = ""
        if self._deck.emergency.state.engaged:
            why = _("AUTO stays off while the emergency stop is in force.")
        elif feed.replay is not None:
            why = _("AUTO stays off: this is a recording.")
        elif feed.graph is None:
            why = _("AUTO stays off: no lesson is running.")
        self.auto = not why
        words = _("AUTO is on: a valid answer is sent at once, without {key}.")
        self.line.show_note(why or words.format(key=self._send_key()), "warning")
        self._changed()

    def end_auto(self, why: str = "") -> None:
        """Send nothing by itself any more; `why` is shown if it did so far."""
        if self.auto:
            self.auto = False
            self.line.show_note(why, "warning")
            self._changed()

    def stopped(self) -> None:
        """End AUTO, since the emergency stop is in force."""
        self.end_auto(_("AUTO is off: the emergency stop has ended it."))

    def session_changed(self) -> None:
        """Hang up, forget the robot, and share the budget of the new session."""
        self.senses = RobotSenses()
        self.cancel()
        self.end_auto(_("AUTO is off: the session has changed."))
        session = self._deck.feed.session
        run = "" if session is None else session.run_id
        if run != self._run:
            self._run = run
            folder = run_folder({**os.environ, RUN_ID: run}) if run else None
            old, self.models = self.models, AskedModels(COMPOSER, folder)
            self.run_worker(old.close(), group="close")
            self.show_status()

    # ---------------------------------------------------------------- what is shown

    def _show_progress(self) -> None:
        """Show how far the answer has come."""
        question = self._question
        if question is None:
            return
        text = question.text
        self.editor.grow_to(text)
        count, problems = so_far(text)
        self.verdict.show(problems, 0, _progress(question, count, len(problems)))
        if question.refused:
            words = _("The first answer was not valid ({problem}): {model} is asked once more.")
            told = words.format(problem=problem_words(question.refused[0]), model=plain(question.model, 60))
            self.line.show_note(told, "warning")

    def read_settings(self) -> None:
        """Read the settings again, and show which model would be asked."""
        self._settings = None
        try:
            self._settings = load()
        except ModelError as fault:
            self.line.field.placeholder = _("Say what the robot should do")
            self.line.show_status(fault_words(fault))
            return
        self.line.field.placeholder = _placeholder(self._settings)
        self.show_status()

    def show_status(self) -> None:
        """Show model, tokens, times, cost, and what is left of the budget."""
        settings = self._settings
        if settings is None:
            return
        usage = None if self._answer is None else self._answer[1]
        lines = [] if usage is None else [usage_words(usage_of(usage, settings.prices))]
        try:
            lines.append(budget_words(budget_of(self.models.ledger.totals(), settings.budget)))
        except ModelError as fault:
            lines.append(fault_words(fault))
        self.line.show_status("\n".join(lines))


def fault_words(fault: ModelError) -> str:
    """Return why there is no answer, and what can be done about it."""
    fix = localized(fault.fix)
    return localized(fault.words) + (f" — {fix}" if fix else "")


def _progress(question: ModelQuestion, commands: int, problems: int) -> str:
    model = plain(question.model, 40)
    if not question.pieces:
        seconds = int(time.monotonic() - question.begun_s)
        return _("asking {model}: {seconds} s").format(model=model, seconds=seconds)
    state = ngettext("{n} command so far", "{n} commands so far", commands).format(n=commands)
    if problems:
        state = ngettext("{n} problem so far", "{n} problems so far", problems).format(n=problems)
    return _("{model} answers: {state}").format(model=model, state=state)


def _placeholder(settings: ModelSettings | None) -> str:
    if settings is None:
        return _("No language model is set up: see docs/models.md")
    words = _("Say what the robot should do: Enter asks {model}")
    return words.format(model=plain(settings.model, 60))
