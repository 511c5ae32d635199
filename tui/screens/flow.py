"""One timeline across nodes: what followed from a word that was said."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.widgets import Static

from tui.i18n import N_, _
from tui.screens.base import DeckScreen

if TYPE_CHECKING:
    from textual.app import ComposeResult


class FlowScreen(DeckScreen):
    """Says that there is no timeline yet."""

    tab: ClassVar[str] = "flow"
    about: ClassVar[str] = N_("One timeline of all nodes: what followed from a word that was said.")

    def compose_body(self) -> ComposeResult:
        """Words in place of the timeline."""
        yield Static(_("There is no timeline yet."), markup=False)
