"""Processes that an earlier run left behind, with an offer to stop them."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content

from text.i18n import N_, _, ngettext
from text.plain import plain
from tui.actions import Action, bindings
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from textual.binding import BindingType

    from launcher.status import Stray


class StopStrays(Action["StraysScreen"]):
    """Stop them."""

    id = "strays.stop"
    key = "enter"
    title = N_("Stop them")
    tooltip = N_("Stop what an earlier run has left behind.")
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: StraysScreen) -> None:
        target.dismiss(True)


class LeaveStrays(Action["StraysScreen"]):
    """Leave them running."""

    id = "strays.leave"
    key = "escape"
    title = N_("Leave them")
    tooltip = N_("Leave them running; they may disturb this session.")
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: StraysScreen) -> None:
        target.dismiss(False)


class StraysScreen(Dialog[bool]):
    """Asks what to do with them."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(StopStrays, LeaveStrays)

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
