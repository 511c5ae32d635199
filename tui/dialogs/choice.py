"""A choice of one of several things: a few words, and a list in which Enter takes one."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Static

from text.i18n import N_
from text.plain import plain_lines
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog
from tui.frame.key_bar import KeyBar
from tui.widgets.rows import Cell, Column, Row, Rows

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from textual.app import ComposeResult
    from textual.binding import BindingType

action: Announce[ChoiceScreen] = Announce()


@action(
    "choice.take", "enter", N_("Take it"), N_("Take the selected one."), footer=True, priority=True, palette=False
)
def take_choice(dialog: ChoiceScreen) -> None:
    dialog.take()


@action("choice.leave", "escape", N_("None of them"), N_("Leave everything as it is."), footer=True, palette=False)
def leave_choice(dialog: ChoiceScreen) -> None:
    dialog.dismiss("")


class ChoiceScreen(Dialog[str]):
    """Asks which one; the answer is its key, or empty."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(take_choice, leave_choice)
    DEFAULT_CSS = """
    ChoiceScreen {
        #choices { height: auto; max-height: 12; margin-bottom: 1; }
        #dialog-text { padding: 1 1 0 1; }
    }
    """

    def __init__(
        self, title: Callable[[], str], words: Callable[[], str], choices: Mapping[str, str], chosen: str = ""
    ) -> None:
        """Offer `choices`, key to text, with `chosen` or the first one chosen.

        `title` and `words` say it in the current language.
        """
        super().__init__()
        self._title = title
        self._words = words
        self._choices = choices
        self._chosen = chosen

    def compose(self) -> ComposeResult:
        """The words above the list."""
        with Vertical(id="dialog"):
            yield Static(id="dialog-text", markup=False)
            yield Rows(header=False, id="choices")
            yield KeyBar()

    def on_mount(self) -> None:
        """Show the list with the one chosen that is to be."""
        rows = self.query_one(Rows)
        rows.show([Column("")], [Row(key, (Cell(text),)) for key, text in self._choices.items()])
        if self._chosen in self._choices:
            rows.choose(self._chosen)
        rows.focus()

    def title_words(self) -> str:
        return self._title()

    def words(self) -> Content:
        return Content(plain_lines(self._words()))

    def take(self) -> None:
        self.dismiss(self.query_one(Rows).chosen)

    def on_rows_opened(self, message: Rows.Opened) -> None:
        """Answer with one that was clicked twice."""
        message.stop()
        self.dismiss(message.key)
