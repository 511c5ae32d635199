"""The frame of every dialog: a box with a title over the screen, its keys at the bottom."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from textual.containers import Vertical, VerticalScroll
from textual.content import Content
from textual.screen import ModalScreen
from textual.widgets import Static

from text.i18n import N_
from text.plain import plain
from tui.actions import Acting, Action, Announce, bindings
from tui.frame.host import Host, host_of
from tui.frame.key_bar import KeyBar
from tui.widgets.working import Working

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.binding import BindingType

    from tui.session.messages import LanguageChanged

Answer = TypeVar("Answer")

action: Announce[Dialog[Any]] = Announce()


@action(
    "help.dialog",
    "f1",
    N_("Help"),
    N_("Every key of this screen, and what it shows."),
    means="help",
    palette=False,
    when=lambda dialog: dialog.can_be_covered,
)
def explain_dialog(dialog: Dialog[Any]) -> None:
    dialog.deck.show_help()


class Dialog(ModalScreen[Answer], Acting, Working):
    """A title and a text; a subclass supplies them, and binds the possible answers."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(explain_dialog)
    can_be_covered: ClassVar[bool] = True
    """Whether another screen may be opened on top of it."""
    DEFAULT_CSS: ClassVar[str] = """
    Dialog {
        align: center middle;
        #dialog {
            width: 80; max-width: 96%; height: auto; max-height: 96%;
            background: $surface; border: round $accent; padding: 0 1;
            border-title-color: $accent; border-title-style: bold;
        }
        #dialog-scroll { height: auto; max-height: 100%; margin-bottom: 1; }
        #dialog-text { height: auto; padding: 1 1; }
        KeyBar { background: $surface; }
    }
    """

    @property
    def deck(self) -> Host:
        return host_of(self)

    @abstractmethod
    def title_words(self) -> str:
        """Return the title."""

    @abstractmethod
    def words(self) -> Content:
        """Return the text for the current state."""

    def compose(self) -> ComposeResult:
        """Put the frame around the text."""
        with Vertical(id="dialog"):
            with VerticalScroll(id="dialog-scroll"):
                yield Static(id="dialog-text", markup=False)
            yield KeyBar()

    def on_mount(self) -> None:
        self.redraw()

    def on_language_changed(self, message: LanguageChanged) -> None:
        del message
        self.redraw()

    def redraw(self) -> None:
        """Show the text for the current state, in the current language."""
        self.query_one("#dialog").border_title = Content(plain(self.title_words()))
        self.query_one("#dialog-text", Static).update(self.words())


def answers(*rows: tuple[str, str, str, str, object]) -> list[BindingType]:
    """Return bindings of keys that close a dialog: of each the id, key, title, tooltip and answer."""
    return bindings(*(_answer(*row) for row in rows))


def _answer(id: str, key: str, title: str, tooltip: str, answer: object) -> Action[Dialog[Any]]:
    @action(id, key, title, tooltip, footer=True, palette=False)
    def close(dialog: Dialog[Any]) -> None:
        dialog.dismiss(answer)

    return close
