"""Says where the viewer is open, with what is to be copied."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content

from text.i18n import N_, _
from text.plain import plain
from tui.actions import Action, bindings
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.binding import BindingType

    from tui.viewing.process import OpenedView


class CloseView(Action["ViewDialog"]):
    """Back to the screen; the viewer stays open."""

    id = "view.close"
    key = "escape,enter"
    title = N_("Close")
    tooltip = N_("Back to the screen; the viewer stays open.")
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: ViewDialog) -> None:
        target.dismiss()


class CopyViewUrl(Action["ViewDialog"]):
    """Copy the address of the page."""

    id = "view.copy"
    key = "y,н"
    title = N_("Copy")
    tooltip = N_("Copy the address of the page, to open it in a browser.")
    footer = True
    palette = False

    @classmethod
    def possible(cls, target: ViewDialog) -> bool | None:
        """Not for a window of its own."""
        return bool(target.opened.url)

    @classmethod
    async def run(cls, target: ViewDialog) -> None:
        target.copy(target.opened.url)


class CopyViewAll(Action["ViewDialog"]):
    """Copy the command that forwards the ports, and the address."""

    id = "view.copy_all"
    key = "ctrl+y"
    title = N_("Copy all")
    tooltip = N_("Copy the command for the machine in front of you, and the address of the page.")
    footer = True
    palette = False

    @classmethod
    def possible(cls, target: ViewDialog) -> bool | None:
        return bool(target.opened.ssh)

    @classmethod
    async def run(cls, target: ViewDialog) -> None:
        target.copy(f"{target.opened.ssh}\n{target.opened.url}")


class EndView(Action["ViewDialog"]):
    """End the viewer."""

    id = "view.end"
    key = "x,ч"
    title = N_("End it")
    means = "stop"
    tooltip = N_("End the viewer; the robot runs on.")
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: ViewDialog) -> None:
        target.end()


class ViewDialog(Dialog[None]):
    """Where the viewer is."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(CloseView, CopyViewUrl, CopyViewAll, EndView)

    def __init__(self, opened: OpenedView, end: Callable[[], None]) -> None:
        """Show where it is open; `end` ends it."""
        super().__init__()
        self.opened = opened
        self._end = end

    def title_words(self) -> str:
        return _("The robot in 3D")

    def words(self) -> Content:
        """Return where it is, and what to do to see it."""
        lines = _window() if not self.opened.url else _page(self.opened)
        ending = _("It only listens, and ends with this session.")
        return Content("\n".join([*map(plain, lines), "", ending]))

    def copy(self, text: str) -> None:
        self.deck.copy_to_clipboard(text)
        self.deck.notify(_("Copied."), markup=False)

    def end(self) -> None:
        self._end()
        self.dismiss()


def _window() -> list[str]:
    return [_("Rerun is open in a window of its own.")]


def _page(opened: OpenedView) -> list[str]:
    if not opened.ssh:
        return [_("Open this page in a browser on this machine:"), "", opened.url]
    return [
        _("On the machine in front of you, run this, which stays open:"),
        "",
        opened.ssh,
        "",
        _("Then open this page there, in a browser:"),
        "",
        opened.url,
    ]
