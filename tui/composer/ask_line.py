"""The line in which a person says what the robot should do, and how the question stands."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.widgets import Input, Static

from text.i18n import _
from text.plain import plain
from tui.widgets.field import Field
from tui.widgets.recalled import Recalled

if TYPE_CHECKING:
    from textual.app import ComposeResult

KEPT = 50
LONGEST = 2000
"""Characters of a question: as many as a model gets."""
LONGEST_NOTE = 600
NoteKind = Literal["", "warning", "error"]


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
        self._said = Recalled(KEPT)

    def compose(self) -> ComposeResult:
        """The note above the line, the status below it."""
        yield Static(id="ask-note", markup=False)
        with Horizontal(id="ask-row"):
            yield Static(id="ask-mark", markup=False)
            yield Field(compact=True, max_length=LONGEST)
        yield Static(id="ask-status", markup=False)

    @property
    def field(self) -> Input:
        return self.query_one(Input)

    @property
    def words(self) -> str:
        """What stands in the field, or what was asked last if it is empty."""
        return self.field.value.strip() or self._said.newest

    def show_mark(self, *, auto: bool) -> None:
        """Show whether a valid answer is sent by itself."""
        mark = self.query_one("#ask-mark", Static)
        mark.set_class(auto, "-auto")
        _show(mark, _("AUTO") if auto else "›")

    def show_model(self, words: str) -> None:
        """Show in the empty field who would be asked."""
        if self.field.placeholder != words:
            self.field.placeholder = words

    def show_status(self, words: str) -> None:
        """Show what the last answer took, and what is left of the budget."""
        _show(self.query_one("#ask-status", Static), words)

    def show_note(self, words: str, kind: NoteKind = "") -> None:
        """Show a sentence until the next one; an empty one shows nothing."""
        note = self.query_one("#ask-note", Static)
        note.set_class(bool(words), "-said")
        note.set_class(kind == "warning", "-warning")
        note.set_class(kind == "error", "-error")
        _show(note, plain(words, LONGEST_NOTE))

    @property
    def note(self) -> str:
        return str(self.query_one("#ask-note", Static).content)

    def action_recall(self, step: int) -> None:
        """Bring back an earlier (-1) or later (1) question."""
        text = self._said.step(step, self.field.value)
        if text is not None:
            self.field.value = text
            self.field.cursor_position = len(text)

    def keep(self, words: str) -> None:
        """Remember a question that was asked, so that it can be recalled."""
        self._said.keep(words)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        event.stop()
        words = event.value.strip()
        if words:
            self.post_message(self.Asked(words))


def _show(label: Static, words: str) -> None:
    if label.content != words:
        label.update(words)
