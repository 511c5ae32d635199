"""Two models and the same words: both answers side by side, with what each has taken."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.containers import Container, Vertical
from textual.content import Content
from textual.events import DescendantFocus
from textual.widgets import Static

from brain.budget import summed
from brain.faults import ModelError
from robot.commands.schema import CommandError, parse_llm
from text.i18n import N_, _, localized, ngettext
from text.plain import plain
from tui.actions import Announce, bindings
from tui.composer.json_editor import JsonEditor
from tui.composer.question import ModelAnswer, ModelQuestion
from tui.dialogs.dialog import Dialog
from tui.frame.key_bar import KeyBar
from tui.frame.screen import BREAKPOINTS, HEIGHTS
from tui.outcome.model_usage import usage_of, usage_words
from tui.outcome.problem_words import problem_words
from tui.widgets.marked_editor import TextPlace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from textual.app import ComposeResult
    from textual.binding import BindingType

    from brain.asking import AskedModels
    from brain.client import Message
    from brain.settings import ModelSettings
    from brain.thinking import Thought
    from robot.commands.schema import LlmResponse, Problem

action: Announce[CompareDialog] = Announce()

PROGRESS_S = 0.1


@action(
    "compare.take",
    "enter",
    N_("Take it"),
    N_("Put the chosen answer into the editor; nothing is sent yet."),
    footer=True,
    priority=True,
    palette=False,
    when=lambda dialog: True if dialog.chosen_answer else None,
)
def take_answer(dialog: CompareDialog) -> None:
    dialog.dismiss(dialog.chosen_answer)


@action(
    "compare.leave",
    "escape",
    N_("None of them"),
    N_("Leave the editor as it is; a question under way is taken back."),
    footer=True,
    priority=True,
    palette=False,
)
def leave_compare(dialog: CompareDialog) -> None:
    dialog.dismiss(None)


@dataclass
class _Compared:
    """One of the two."""

    question: ModelQuestion | None = None
    thought: Thought[LlmResponse] | None = None
    fault: ModelError | None = None

    @property
    def text(self) -> str:
        if self.thought is not None:
            return self.thought.text
        return "" if self.question is None else self.question.text

    @property
    def whole(self) -> bool:
        """Whether nothing more will come."""
        return self.thought is not None or self.fault is not None


class ComparedAnswer(Vertical):
    """The name of a model, its answer, and below it whether it is valid and what it took."""

    DEFAULT_CSS = """
    ComparedAnswer {
        width: 1fr; height: 1fr;
        .compared-title { height: 1; background: $panel; color: $text-muted; padding: 0 1; }
        .compared-below { height: auto; max-height: 6; padding: 0 1; color: $text-success; }
        .compared-below.-wrong { color: $text-error; }
        .compared-below.-coming { color: $text-accent; }
        &:focus-within .compared-title { background: $accent; color: $background; }
    }
    """

    def __init__(self, model: str, settings: ModelSettings) -> None:
        super().__init__()
        self.model, self._settings = model, settings
        self.state = _Compared()

    def compose(self) -> ComposeResult:
        yield Static(plain(self.model, 60), classes="compared-title", markup=False)
        yield JsonEditor()
        yield Static(classes="compared-below", markup=False)

    def on_mount(self) -> None:
        self.query_one(JsonEditor).read_only = True

    def redraw(self) -> None:
        """Show how far it has come."""
        state, editor = self.state, self.query_one(JsonEditor)
        editor.grow_to(state.text)
        problems: tuple[Problem, ...] = ()
        if state.fault is not None and state.text:
            try:
                parse_llm(state.text)
            except CommandError as error:
                problems = error.problems
        editor.show_problems(TextPlace(one.line, one.column) for one in problems)
        below = self.query_one(".compared-below", Static)
        below.set_class(state.fault is not None, "-wrong")
        below.set_class(not state.whole, "-coming")
        words = "\n".join(self._words())
        if below.content != words:
            below.update(words)

    def _words(self) -> list[str]:
        state = self.state
        if state.fault is not None:
            fix = localized(state.fault.fix)
            return [f"✗ {localized(state.fault.words)}" + (f" — {fix}" if fix else "")]
        if state.thought is not None:
            return [*self._valid(state.thought), *self._refused()]
        if state.question is None:
            return ["… " + _("waits for the other model")]
        if not state.question.has_begun:
            words = _("asking {model}: {seconds} s")
            seconds = int(state.question.age_s)
            return ["… " + words.format(model=plain(self.model, 40), seconds=seconds)]
        count, problems = state.question.so_far()
        commands = ngettext("{n} command so far", "{n} commands so far", count).format(n=count)
        wrong = [f"✗ {problem_words(problem)}" for problem in problems[:1]]
        return [f"… {commands}", *self._refused(), *wrong]

    def _valid(self, thought: Thought[LlmResponse]) -> list[str]:
        count = len(thought.value.commands)
        commands = ngettext("{n} command", "{n} commands", count).format(n=count)
        usage = usage_of(summed(thought.usages), self._settings.prices)
        return ["✓ " + _("valid: {commands}").format(commands=commands), usage_words(usage, named=False)]

    def _refused(self) -> list[str]:
        question = self.state.question
        if question is None or not question.refused:
            return []
        words = _("the first answer was not valid: {problem}")
        return ["! " + words.format(problem=problem_words(question.refused[0]))]


class CompareDialog(Dialog[ModelAnswer | None]):
    """Asks one model after the other, so that neither slows the other down; returns one answer."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(take_answer, leave_compare)
    HORIZONTAL_BREAKPOINTS = BREAKPOINTS
    VERTICAL_BREAKPOINTS = HEIGHTS
    DEFAULT_CSS: ClassVar[str] = """
    CompareDialog {
        #dialog { width: 96%; height: 90%; padding: 0; }
        #dialog-text { padding: 0 1; height: auto; max-height: 2; color: $text-muted; }
        #compared { height: 1fr; layout: horizontal; }
        &.-compact #compared, &.-tiny #compared { layout: vertical; }
        &.-low .compared-below, &.-flat .compared-below { max-height: 3; }
    }
    """

    def __init__(
        self,
        words: str,
        models: AskedModels,
        settings: ModelSettings,
        names: tuple[str, str],
        messages: Sequence[Message],
    ) -> None:
        super().__init__()
        self._words, self._models, self._messages = words, models, messages
        self._answers = tuple(ComparedAnswer(name, settings) for name in names)

    def compose(self) -> ComposeResult:
        """The words above both answers."""
        with Vertical(id="dialog"):
            yield Static(id="dialog-text", markup=False)
            with Container(id="compared"):
                yield from self._answers
            yield KeyBar()

    def on_mount(self) -> None:
        self._answers[0].query_one(JsonEditor).focus()
        self.set_interval(PROGRESS_S, self._progress)
        self.run_worker(self._ask(), group="compare")

    def title_words(self) -> str:
        return _("Two models, the same words")

    def words(self) -> Content:
        return Content(f"“{plain(self._words, 300)}” · " + _("Tab goes to the other answer"))

    def redraw(self) -> None:
        """Show everything, in the current language."""
        super().redraw()
        self._progress()

    @property
    def chosen(self) -> ComparedAnswer:
        return next((one for one in self._answers if one.has_focus_within), self._answers[0])

    @property
    def chosen_answer(self) -> ModelAnswer | None:
        """It, if nothing more will come and there is a text."""
        state = self.chosen.state
        if not state.whole or not state.text:
            return None
        usage = None if state.thought is None else summed(state.thought.usages)
        return ModelAnswer(state.text, usage)

    @on(DescendantFocus)
    def _chosen_changed(self) -> None:
        self.refresh_bindings()

    async def _ask(self) -> None:
        for one in self._answers:
            question = one.state.question = ModelQuestion(self._words, one.model)
            try:
                one.state.thought = await self._models.ask(one.model, self._messages, question.take, question.repair)
            except ModelError as fault:
                one.state.fault = fault
            self._progress()
            one.query_one(JsonEditor).move_cursor((0, 0))
            self.refresh_bindings()

    def _progress(self) -> None:
        for one in self._answers:
            one.redraw()
