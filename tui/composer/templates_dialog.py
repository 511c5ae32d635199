"""The dialog in which a template is chosen."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import OptionList, Static

from text.i18n import _
from tui.composer.templates import TEMPLATES
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from textual.app import ComposeResult


class TemplatesDialog(Dialog[str | None]):
    """Answers with the text of the template, None if none was chosen."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", show=False)]
    DEFAULT_CSS: ClassVar[str] = """
    TemplatesDialog OptionList { height: auto; background: $surface; }
    TemplatesDialog #dialog-text { padding: 1 0 0 0; color: $text-muted; }
    """

    def title_words(self) -> str:
        """Return the title."""
        return _("Templates")

    def words(self) -> Content:
        """Return what the keys do."""
        return Content(_("Enter takes one, Escape leaves"))

    def compose(self) -> ComposeResult:
        """Put the frame around the list."""
        with Vertical(id="dialog"):
            yield OptionList(*(_(one.title) for one in TEMPLATES), markup=False, compact=True)
            yield Static(id="dialog-text", markup=False)

    def on_mount(self) -> None:
        """Begin in the list."""
        self.query_one(OptionList).focus()

    def action_leave(self) -> None:
        """Choose none."""
        self.dismiss(None)

    @on(OptionList.OptionSelected)
    def _selected(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(TEMPLATES[event.option_index].text())
