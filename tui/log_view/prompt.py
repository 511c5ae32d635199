"""One line that asks a question: what to search for, where to save."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.binding import Binding, BindingType
from textual.containers import Horizontal
from textual.message import Message
from textual.widgets import Input, Static

from tui.widgets.field import Field

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.widget import Widget


class LogPrompt(Horizontal):
    """A label, a text field and room for a remark; hidden until `ask` is called.

    `kind` says what was asked. Escape cancels.
    """

    DEFAULT_CSS = """
    LogPrompt {
        display: none;
        height: 1;
        background: $boost;
        &.-asking { display: block; }
        #label { width: auto; padding: 0 1; text-style: bold; }
        #remark { width: auto; max-width: 50%; padding: 0 1; color: $text-warning; }
        Input { width: 1fr; }
    }
    """
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "give_up", show=False)]

    class Said(Message):
        """Base of its messages."""

        def __init__(self, prompt: LogPrompt, text: str) -> None:
            super().__init__()
            self.prompt, self.kind, self.text = prompt, prompt.kind, text

        @property
        def control(self) -> Widget:
            return self.prompt

    class Edited(Said):
        """The text has changed."""

    class Answered(Said):
        """Enter was pressed."""

    class Cancelled(Said):
        """Escape was pressed."""

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self.kind = ""

    def compose(self) -> ComposeResult:
        yield Static("", id="label", markup=False)
        yield Field(compact=True, select_on_focus=False)
        yield Static("", id="remark", markup=False)

    def ask(self, kind: str, label: str, text: str) -> None:
        """Ask, with `text` as the default answer."""
        self.kind = kind
        self.add_class("-asking")
        self.query_one("#label", Static).update(label)
        self.remark("")
        field = self.query_one(Input)
        with self.prevent(Input.Changed):
            field.value = text
        field.cursor_position = len(text)
        self.screen.set_focus(field)

    def remark(self, words: str) -> None:
        """Show a remark about the answer."""
        self.query_one("#remark", Static).update(words)

    def close(self) -> None:
        self.kind = ""
        self.remove_class("-asking")

    def on_input_changed(self, event: Input.Changed) -> None:
        """Report the text being typed."""
        event.stop()
        self.remark("")
        self.post_message(self.Edited(self, event.value))

    def on_input_submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self.post_message(self.Answered(self, event.value))

    def action_give_up(self) -> None:
        self.post_message(self.Cancelled(self, self.query_one(Input).value))
