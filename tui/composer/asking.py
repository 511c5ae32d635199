"""Asks a model from the Composer: the answer grows in the editor, and waits there to be sent.

In `auto` a valid answer is sent by itself. That ends with the emergency stop, with the session, and
with anything that goes wrong.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Protocol

from brain.asking import AskedModels
from brain.budget import summed
from brain.faults import FaultKind, ModelError
from brain.prompt import prompt_file, read_prompt
from brain.settings import load, settings_path
from launcher.status import LogLine, Severity
from text.i18n import N_, _, language, localized, ngettext
from text.plain import plain
from text.run_path import RUN_ID, run_folder
from tui import clock
from tui.composer.compare import CompareDialog
from tui.composer.question import ModelAnswer, ModelQuestion
from tui.outcome.model_usage import COMPOSER, budget_of, budget_words, noted, usage_of, usage_words
from tui.outcome.problem_words import problem_words

if TYPE_CHECKING:
    from collections.abc import Coroutine

    from textual.worker import Worker

    from brain.client import Message
    from brain.settings import ModelSettings
    from brain.thinking import Thought
    from robot.commands.schema import LlmResponse
    from tui.composer.ask_line import AskLine
    from tui.composer.json_editor import JsonEditor
    from tui.composer.senses import RobotSenses
    from tui.composer.verdict import JsonVerdict
    from tui.frame.host import Host
    from tui.session.feed import Feed

PROMPT = "composer"
_BY_STOP = N_("AUTO is off: the emergency stop has ended it.")
_BY_FAULT = N_("AUTO is off.")


def fault_words(fault: ModelError) -> str:
    """Return why there is no answer, and what can be done about it."""
    fix = localized(fault.fix)
    return localized(fault.words) + (f" — {fix}" if fix else "")


class AskingScreen(Protocol):
    """The part of the Composer that a question changes."""

    senses: RobotSenses
    """What is known of the robot."""

    @property
    def deck(self) -> Host:
        """The app."""

    @property
    def feed(self) -> Feed:
        """The session."""

    @property
    def editor(self) -> JsonEditor:
        """The editor with the JSON."""

    @property
    def verdict(self) -> JsonVerdict:
        """The problems in the JSON."""

    @property
    def line(self) -> AskLine:
        """The line in which a model is asked."""

    @property
    def send_key(self) -> str:
        """The key that sends, as it is written."""

    def check(self) -> None:
        """Check the JSON."""

    def send(self) -> bool:
        """Send the JSON if it is valid; return whether it went out."""

    def asking_changed(self) -> None:
        """Show whether a model is asked, and whether its answers are sent by themselves."""

    def run_worker(self, work: Coroutine[Any, Any, None], *, group: str) -> Worker[None]:
        """Run something beside the screen, for as long as it is there."""


class ComposerAsking:
    """One question at a time; `screen` shows it, and sends what comes of it."""

    def __init__(self, screen: AskingScreen) -> None:
        self._screen = screen
        self.models = AskedModels(COMPOSER)
        self.auto = False
        """Whether a valid answer is sent by itself."""
        self.answer: ModelAnswer | None = None
        """The last valid answer."""
        self._question: ModelQuestion | None = None
        self._worker: Worker[None] | None = None
        self._run = ""
        self._settings: ModelSettings | None = None
        self._notes = 0

    @property
    def under_way(self) -> bool:
        return self._question is not None

    def messages(self, words: str) -> list[Message]:
        """Return what a model gets: the prompt, and how things stand.

        Raises:
            ModelError: if the prompt cannot be read.
        """
        prompt = read_prompt(prompt_file("", PROMPT, language()))
        situation = self._screen.senses.situation(words)
        return [{"role": "system", "content": prompt}, situation.message()]

    # ---------------------------------------------------------------- asking

    def ask(self, words: str) -> None:
        if self.under_way:
            return
        screen = self._screen
        try:
            settings = self._settings = self.models.settings()
            messages = self.messages(words)
        except ModelError as fault:
            self._show_fault(fault)
            return
        screen.line.show_model(_placeholder(settings))
        screen.line.keep(words)
        screen.line.show_note("")
        question = self._question = ModelQuestion(words, settings.model)
        screen.editor.begin_growing()
        self._worker = screen.run_worker(self._ask(question, messages), group="ask")
        screen.asking_changed()
        self.show_progress()

    async def _ask(self, question: ModelQuestion, messages: list[Message]) -> None:
        try:
            thought = await self.models.ask(question.model, messages, question.take, question.repair)
        except ModelError as fault:
            if question is self._question:
                self._failed(question, fault)
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
        if self._question is None:
            return
        self._question = None
        if worker is not None:
            worker.cancel()
        self._finish(None)
        self._screen.line.show_note(_("The question was taken back."))

    def end(self) -> None:
        """Hang up, and show nothing any more."""
        worker, self._worker, self._question = self._worker, None, None
        if worker is not None:
            worker.cancel()

    def _answered(self, question: ModelQuestion, thought: Thought[LlmResponse]) -> None:
        screen = self._screen
        self._question = None
        self.answer = ModelAnswer(thought.text, summed(thought.usages))
        self._finish(thought.text)
        if screen.deck.emergency.state.engaged:
            self.end_auto(_(_BY_STOP))
        sends = self.auto
        if sends and not screen.send():
            self.end_auto()
            sends = False
        self._say_answered(question, sent=sends)
        # Whoever already writes the next question must not find the letters in the JSON.
        if not sends and screen.line.field.value.strip() in ("", question.words):
            screen.line.field.value = ""
            screen.editor.focus()
        elif sends and screen.line.field.value.strip() == question.words:
            screen.line.field.value = ""

    def _say_answered(self, question: ModelQuestion, *, sent: bool) -> None:
        parts = []
        if question.refused:
            words = _("The first answer was not valid ({problem}); the second is.")
            parts.append(words.format(problem=problem_words(question.refused[0])))
        if sent:
            parts.append(_("Sent by itself."))
        else:
            words = _("{send} sends the answer, {undo} brings back what stood here.")
            parts.append(words.format(send=self._screen.send_key, undo="^z"))
        self._screen.line.show_note(" ".join(parts), "warning" if question.refused else "")

    def _failed(self, question: ModelQuestion, fault: ModelError) -> None:
        self._question = None
        # What cannot be accepted is worth a look: it stands there with all that is wrong in it.
        self._finish(question.text if fault.kind is FaultKind.SHAPE else None)
        self._show_fault(fault)

    def _show_fault(self, fault: ModelError) -> None:
        words = f"✗ {fault_words(fault)}"
        if self.auto:
            self.end_auto()
            words += " · " + _(_BY_FAULT)
        self._screen.line.show_note(words, "error")
        self.show_status()

    def _finish(self, text: str | None) -> None:
        screen = self._screen
        screen.editor.end_growing(text or None)
        screen.check()
        screen.asking_changed()
        self.show_status()

    def comparison(self) -> CompareDialog | None:
        """Return the dialog that asks both models of the settings; None if that cannot be."""
        line = self._screen.line
        words = line.words
        if self.under_way:
            return None
        try:
            settings = self.models.settings()
            messages = self.messages(words)
        except ModelError as fault:
            self._show_fault(fault)
            return None
        if settings.compare_with is None:
            told = _("There is no second model to compare with: write compare_with: MODEL in {path}")
            line.show_note(told.format(path=plain(str(settings_path()))), "warning")
            return None
        if not words:
            line.show_note(_("Say in the line what both models shall be asked."), "warning")
            line.field.focus()
            return None
        line.keep(words)
        names = settings.model, settings.compare_with
        return CompareDialog(words, self.models, settings, names, messages)

    def note_sent(self, text: str) -> None:
        """Note in the log what an answer took that was sent as it came: Flow shows it, too."""
        answer, settings = self.answer, self._settings
        if answer is None or self._screen.editor.shown(answer.text) != text:
            return
        # It may still say how to send it.
        self._screen.line.show_note("")
        if answer.usage is None or settings is None:
            return
        self._notes += 1
        words = noted(usage_of(answer.usage, settings.prices))
        line = LogLine(COMPOSER, self._notes, clock.now(), Severity.INFO, words, source="deck")
        self._screen.feed.note([line])

    # ---------------------------------------------------------------- auto

    def toggle_auto(self) -> None:
        """Send valid answers by themselves from now on, or no longer."""
        screen = self._screen
        if self.auto:
            self.end_auto()
            return
        why = ""
        if screen.deck.emergency.state.engaged:
            why = _("AUTO stays off while the emergency stop is in force.")
        elif screen.feed.replay is not None:
            why = _("AUTO stays off: this is a recording.")
        elif screen.feed.graph is None:
            why = _("AUTO stays off: no lesson is running.")
        if why:
            screen.line.show_note(why, "warning")
            return
        self.auto = True
        words = _("AUTO is on: a valid answer is sent at once, without {key}.")
        screen.line.show_note(words.format(key=screen.send_key), "warning")
        screen.asking_changed()

    def end_auto(self, why: str = "") -> None:
        """Send nothing by itself any more; `why` is shown if it did so far."""
        if not self.auto:
            return
        self.auto = False
        self._screen.line.show_note(why, "warning")
        self._screen.asking_changed()

    def stopped(self) -> None:
        """End `auto`, since the emergency stop is in force."""
        self.end_auto(_(_BY_STOP))

    def session_changed(self) -> None:
        """Hang up, and share the budget of the new session."""
        self.cancel()
        self.end_auto(_("AUTO is off: the session has changed."))
        session = self._screen.feed.session
        run = "" if session is None else session.run_id
        if run != self._run:
            self._run = run
            folder = run_folder({**os.environ, RUN_ID: run}) if run else None
            old, self.models = self.models, AskedModels(COMPOSER, folder)
            self._screen.run_worker(old.close(), group="close")
            self.show_status()

    # ---------------------------------------------------------------- what is shown

    def show_progress(self) -> None:
        """Show how far the answer has come."""
        question, screen = self._question, self._screen
        if question is None:
            return
        screen.editor.grow_to(question.text)
        count, problems = question.so_far()
        screen.verdict.show_under_way(_progress(question, count, len(problems)), problems)
        if question.refused:
            words = _("The first answer was not valid ({problem}): {model} is asked once more.")
            told = words.format(problem=problem_words(question.refused[0]), model=plain(question.model, 60))
            screen.line.show_note(told, "warning")

    def read_settings(self) -> None:
        """Read the settings again, and show which model would be asked."""
        line = self._screen.line
        self._settings = None
        try:
            self._settings = load()
        except ModelError as fault:
            line.show_model(_("Say what the robot should do"))
            line.show_status(fault_words(fault))
            return
        line.show_model(_placeholder(self._settings))
        self.show_status()

    def show_status(self) -> None:
        """Show model, tokens, times, cost, and what is left of the budget."""
        settings = self._settings
        if settings is None:
            return
        try:
            budget = budget_words(budget_of(self.models.ledger.totals(), settings.budget))
        except ModelError as fault:
            budget = fault_words(fault)
        parts = filter(None, (self._usage_words(settings), budget))
        self._screen.line.show_status("\n".join(parts))

    def _usage_words(self, settings: ModelSettings) -> str:
        if self.answer is None or self.answer.usage is None:
            return ""
        return usage_words(usage_of(self.answer.usage, settings.prices))


def _progress(question: ModelQuestion, commands: int, problems: int) -> str:
    model = plain(question.model, 40)
    if not question.has_begun:
        words = _("asking {model}: {seconds} s")
        return words.format(model=model, seconds=int(question.age_s))
    if problems:
        wrong = ngettext("{n} problem so far", "{n} problems so far", problems).format(n=problems)
        return _("{model} answers: {state}").format(model=model, state=wrong)
    state = ngettext("{n} command so far", "{n} commands so far", commands).format(n=commands)
    return _("{model} answers: {state}").format(model=model, state=state)


def _placeholder(settings: ModelSettings | None) -> str:
    if settings is None:
        return _("No language model is set up: see docs/models.md")
    words = _("Say what the robot should do: Enter asks {model}")
    return words.format(model=plain(settings.model, 60))
