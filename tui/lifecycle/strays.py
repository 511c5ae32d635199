"""Processes that an earlier run left behind, with an offer to stop them."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content

from text.i18n import N_, _, ngettext
from text.plain import plain
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from textual.binding import BindingType

    from launcher.status import Stray

action: Announce[StraysScreen] = Announce()


@action(
    "strays.stop",
    "enter",
    N_("Stop them"),
    N_("Stop what an earlier run has left behind."),
    footer=True,
    palette=False,
)
def stop_strays(dialog: StraysScreen) -> None:
    dialog.dismiss(True)


@action(
    "strays.leave",
    "escape",
    N_("Leave them"),
    N_("Leave them running; they may disturb this session."),
    footer=True,
    palette=False,
)
def leave_strays(dialog: StraysScreen) -> None:
    dialog.dismiss(False)


class StraysScreen(Dialog[bool]):
    """Asks what to do with them."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(stop_strays, leave_strays)

    def __init__(self, strays: tuple[Stray, ...]) -> None:
        super().__init__()
        self._strays = strays

    def title_words(self) -> str:
        return _("Left behind by an earlier run")

    def words(self) -> Content:
        count = len(self._strays)
        lines = [
            Content(
                ngettext(
                    "{n} process of an earlier run is still alive and may disturb this one:",
                    "{n} processes of an earlier run are still alive and may disturb this one:",
                    count,
                ).format(n=count)
            )
        ]
        lines += [
            Content.assemble(
                (f"{stray.pid:>8}  ", "$text-muted"),
                (plain(stray.node, 60), "bold"),
                (f"  {plain(stray.command, 200)}", "$text-muted"),
            )
            for stray in self._strays
        ]
        return Content("\n").join(lines)
