"""Says where the viewer is open, with what is to be copied."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content

from text.i18n import N_, _
from text.plain import plain
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.binding import BindingType

    from tui.viewing.process import OpenedView

action: Announce[ViewDialog] = Announce()


@action(
    "view.close",
    "escape,enter",
    N_("Close"),
    N_("Back to the screen; the viewer stays open."),
    footer=True,
    palette=False,
)
def close_view(dialog: ViewDialog) -> None:
    dialog.dismiss()


@action(
    "view.copy",
    "y",
    N_("Copy"),
    N_("Copy the address of the page, to open it in a browser."),
    footer=True,
    palette=False,
    when=lambda dialog: bool(dialog.opened.url),
)
def copy_view_url(dialog: ViewDialog) -> None:
    dialog.copy(dialog.opened.url)


@action(
    "view.copy_all",
    "ctrl+y",
    N_("Copy all"),
    N_("Copy the command for the machine in front of you, and the address of the page."),
    footer=True,
    palette=False,
    when=lambda dialog: bool(dialog.opened.ssh),
)
def copy_view_all(dialog: ViewDialog) -> None:
    dialog.copy(f"{dialog.opened.ssh}\n{dialog.opened.url}")


@action(
    "view.end", "x", N_("End it"), N_("End the viewer; the robot runs on."), means="stop", footer=True, palette=False
)
def end_view(dialog: ViewDialog) -> None:
    dialog.end()


class ViewDialog(Dialog[None]):
    """Where the viewer is."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(close_view, copy_view_url, copy_view_all, end_view)

    def __init__(self, opened: OpenedView, end: Callable[[], None]) -> None:
        """Show where it is open; `end` ends it."""
        super().__init__()
        self.opened: OpenedView = opened
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
