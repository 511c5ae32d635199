"""The fields of the Composer: the JSON, the verdict on it, and the line in which a model is asked."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, ClassVar, Literal

from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.document._history import EditHistory
from textual.message import Message
from textual.widgets import Input, OptionList, Static

from robot.limits import MAX_BYTES
from text.i18n import _, ngettext
from text.plain import plain
from tui.outcome.words import problem_words
from tui.widgets.field import Field
from tui.widgets.marked_editor import MarkedEditor, TextPlace, Token
from tui.widgets.recalled import Recalled

if TYPE_CHECKING:
    from collections.abc import Iterator

    from textual.app import ComposeResult

    from robot.commands.schema import Problem

_TOKEN = re.compile(
    r"""
    (?P<string>"(?:[^"\\]|\\.)*(?P<closed>"?))
    | (?P<number>-?\d[\w.+-]*)
    | (?P<word>[^\W\d]\w*)
    | (?P<mark>[{}\[\],:])
    | (?P<other>\S)
    """,
    re.VERBOSE,
)
_KEY_FOLLOWS = re.compile(r"\s*:")
_NUMBER = re.compile(r"-?(0|[1-9]\d*)(\.\d+)?([eE][+-]?\d+)?")
_WORDS = frozenset({"true", "false", "null"})


def _kind(match: re.Match[str], line: str) -> str:
    kind, text = match.lastgroup, match.group()
    if match.group("string") is not None:
        if not match.group("closed"):
            return "bad"
        return "key" if _KEY_FOLLOWS.match(line, match.end()) else "string"
    if kind == "number":
        return "number" if _NUMBER.fullmatch(text) else "bad"
    if kind == "word":
        return "word" if text in _WORDS else "bad"
    return "mark" if kind == "mark" else "bad"


class JsonEditor(MarkedEditor):
    """Edits JSON with its syntax in colour, no longer than the robot accepts."""

    longest: ClassVar[int] = MAX_BYTES
    _before: tuple[str, EditHistory] | None = None
    """The text, and how to undo it, that an answer under way has replaced."""

    def tokens_of(self, line: str) -> Iterator[Token]:
        for match in _TOKEN.finditer(line):
            yield Token(match.start(), match.end(), _kind(match, line))

    def begin_growing(self) -> None:
        """Show an answer as it comes, in place of the text, which nobody can edit meanwhile."""
        self._before = self.text, self.history
        # What comes piece by piece is taken back as a whole.
        self.history = EditHistory(1, 0.0, 0)
        self.read_only = True
        self.show_problems(())
        self.grow_to("")

    def grow_to(self, text: str) -> None:
        shown, now = self.shown(text), self.text
        if shown == now:
            return
        if shown.startswith(now):
            self.insert(shown[len(now) :], self.document.end)
        else:
            self.replace(shown, self.document.start, self.document.end)
        self.move_cursor(self.document.end)

    def end_growing(self, text: str) -> None:
        """Show the whole answer, which can be undone; without one the text from before."""
        if self._before is None:
            return
        before, history = self._before
        self._before = None
        self.replace_all(before)
        self.history = history
        self.read_only = False
        if text and self.shown(text) != before:
            self.history.checkpoint()
            self.replace_all(text)
            self.history.checkpoint()


class JsonVerdict(Vertical):
    """One line with a mark and a word, and below it the problems; Enter goes to where one is."""

    class ProblemWanted(Message):
        """The user wants to go to the place of a problem."""

        def __init__(self, place: TextPlace) -> None:
            super().__init__()
            self.place = place

    DEFAULT_CSS = """
    JsonVerdict {
        height: auto; max-height: 40%;
        & > Static { height: 1; background: $panel; color: $text-success; padding: 0 1; }
        & > OptionList {
            height: auto; max-height: 1fr; display: none; background: $background; padding: 0 1;
            scrollbar-size: 1 1;
        }
        &.-wrong > Static { color: $text-error; text-style: bold; }
        &.-wrong > OptionList { display: block; }
        &.-coming > Static { color: $text-accent; text-style: none; }
    }
    """

    def __init__(self) -> None:
        super().__init__()
        self._shown: tuple[tuple[Problem, ...], int, str] | None = None

    def compose(self) -> ComposeResult:
        yield Static(markup=False)
        yield OptionList(markup=False, compact=True)

    def show(self, problems: tuple[Problem, ...], commands: int, coming: str = "") -> None:
        """Show the problems or, if there are none, the number of commands.

        `coming` says how far an answer has come whose beginning they are of.
        """
        if (problems, commands, coming) != self._shown:
            self._shown = problems, commands, coming
            self.redraw()

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The current problems; none of an answer that still comes."""
        return () if self._shown is None or self._shown[2] else self._shown[0]

    def redraw(self) -> None:
        if self._shown is None:
            return
        problems, commands, coming = self._shown
        self.set_class(bool(problems), "-wrong")
        self.set_class(bool(coming) and not problems, "-coming")
        count = len(problems)
        if coming:
            words = f"{'✗' if count else '…'} {coming}"
        elif count:
            words = "✗ " + ngettext("{n} problem", "{n} problems", count).format(n=count)
        else:
            told = ngettext("{n} command", "{n} commands", commands).format(n=commands)
            words = "✓ " + _("valid: {commands}").format(commands=told)
        self.query_one(Static).update(words)
        listed = self.query_one(OptionList)
        listed.clear_options()
        listed.add_options([problem_words(problem) for problem in problems])

    @on(OptionList.OptionSelected)
    def _selected(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        problem = self.problems[event.option_index : event.option_index + 1]
        for one in problem:
            self.post_message(self.ProblemWanted(TextPlace(one.line, one.column)))


KEPT = 50
LONGEST = 2000
"""Characters of a question: as many as a model gets."""
LONGEST_NOTE = 600


class AskLine(Vertical):
    """A note, the line, and what answers took; Enter posts `Asked`."""

    DEFAULT_CSS = """
    AskLine {
        height: auto; width: 1fr;
        #ask-note { height: auto; max-height: 4; padding: 0 1; color: $text-muted; display: none; }
        #ask-note.-warning { color: $text-warning; }
        #ask-note.-error { color: $text-error; text-style: bold; }
        #ask-note.-said { display: block; }
        #ask-row { height: 1; background: $panel; }
        #ask-mark { width: auto; padding: 0 1; color: $text-accent; text-style: bold; }
        #ask-mark.-auto { background: $warning; color: $background; }
        Input { width: 1fr; }
        #ask-status { height: auto; max-height: 3; padding: 0 1; color: $text-muted; }
    }
    DeckScreen.-flat AskLine #ask-status { display: none; }
    DeckScreen.-flat AskLine #ask-note { max-height: 2; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up", "recall(-1)", show=False),
        Binding("down", "recall(1)", show=False),
    ]

    class Asked(Message):
        """A person has said what the robot should do."""

        def __init__(self, words: str) -> None:
            """Carry the words without surrounding blanks."""
            super().__init__()
            self.words = words

    def __init__(self) -> None:
        super().__init__()
        self.said = Recalled(KEPT)
        """The questions that were asked."""

    def compose(self) -> ComposeResult:
        yield Static(id="ask-note", markup=False)
        with Horizontal(id="ask-row"):
            yield Static(id="ask-mark", markup=False)
            yield Field(compact=True, max_length=LONGEST)
        yield Static(id="ask-status", markup=False)

    @property
    def field(self) -> Input:
        return self.query_one(Input)

    def show_mark(self, *, auto: bool) -> None:
        """Show whether a valid answer is sent by itself."""
        self.query_one("#ask-mark").set_class(auto, "-auto")
        self._show("#ask-mark", _("AUTO") if auto else "›")

    def show_status(self, words: str) -> None:
        """Show what the last answer took, and what is left of the budget."""
        self._show("#ask-status", words)

    def show_note(self, words: str, kind: Literal["", "warning", "error"] = "") -> None:
        """Show a sentence until the next one; an empty one shows nothing."""
        note = self.query_one("#ask-note")
        note.set_class(bool(words), "-said")
        note.set_class(kind == "warning", "-warning")
        note.set_class(kind == "error", "-error")
        self._show("#ask-note", plain(words, LONGEST_NOTE))

    def _show(self, label: str, words: str) -> None:
        static = self.query_one(label, Static)
        if static.content != words:
            static.update(words)

    @property
    def note(self) -> str:
        return str(self.query_one("#ask-note", Static).content)

    def action_recall(self, step: int) -> None:
        """Bring back an earlier (-1) or later (1) question."""
        text = self.said.step(step, self.field.value)
        if text is not None:
            self.field.value = text
            self.field.cursor_position = len(text)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        event.stop()
        words = event.value.strip()
        if words:
            self.post_message(self.Asked(words))
