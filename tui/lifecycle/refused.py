"""Why a lesson could not be opened."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content

from text.i18n import N_, _
from text.plain import plain
from tui.actions import Action, bindings
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from textual.binding import BindingType


class CloseRefused(Action["RefusedScreen"]):
    """Go back to the list."""

    id = "refused.close"
    key = "escape,enter"
    title = N_("Close")
    tooltip = N_("Go back to the list of lessons.")
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: RefusedScreen) -> None:
        target.dismiss()


class RefusedScreen(Dialog[None]):
    """Shows the reason, one line for each problem."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(CloseRefused)

    def __init__(self, reason: str) -> None:
        super().__init__()
        self._reason = reason

    def title_words(self) -> str:
        return _("It could not be opened")

    def words(self) -> Content:
        return Content("\n".join(plain(line) for line in self._reason.splitlines()))
