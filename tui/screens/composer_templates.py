"""The dialog in which a template is chosen."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.binding import Binding, BindingType
from textual.widgets import OptionList

from tui.i18n import _
from tui.screens.dialog import Dialog
from tui.widgets.templates import TEMPLATES

if TYPE_CHECKING:
    from textual.app import ComposeResult


class TemplatesDialog(Dialog[str | None]):
    """Answers with the text of the template, None if none was chosen."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", show=False)]
    DEFAULT_CSS: ClassVar[str] = """
    TemplatesDialog OptionList { height: auto; background: $surface; }
    """

    def title_words(self) -> str:
        """Return the title."""
        return _("Templates: Enter takes one, Escape leaves")

    def compose_text(self) -> ComposeResult:
        """Yield the list."""
        yield OptionList(*(_(one.title) for one in TEMPLATES), markup=False, compact=True)

    def on_mount(self) -> None:
        """Begin in the list."""
        super().on_mount()
        self.query_one(OptionList).focus()

    def action_leave(self) -> None:
        """Choose none."""
        self.dismiss(None)

    @on(OptionList.OptionSelected)
    def _selected(self, event: OptionList.OptionSelected) -> None:
        self.dismiss(TEMPLATES[event.option_index].text())
