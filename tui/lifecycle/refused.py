"""Why a lesson could not be opened."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content

from text.i18n import N_, _
from text.plain import plain
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from textual.binding import BindingType

action: Announce[RefusedScreen] = Announce()


@action(
    "refused.close", "escape,enter", N_("Close"), N_("Go back to the list of lessons."), footer=True, palette=False
)
def close_refused(dialog: RefusedScreen) -> None:
    dialog.dismiss()


class RefusedScreen(Dialog[None]):
    """Shows the reason, one line for each problem."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(close_refused)

    def __init__(self, reason: str) -> None:
        super().__init__()
        self._reason = reason

    def title_words(self) -> str:
        return _("It could not be opened")

    def words(self) -> Content:
        return Content("\n".join(plain(line) for line in self._reason.splitlines()))
