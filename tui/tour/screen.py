"""The pages of the tour, one at a time over the list of lessons; Escape leaves at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.cells import cell_len
from textual.content import Content

from text.i18n import N_, _
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog
from tui.tour.pages import PAGES

if TYPE_CHECKING:
    from textual.binding import BindingType

action: Announce[TourScreen] = Announce()


@action(
    "tour.next",
    "enter,n",
    N_("Next page"),
    N_("Show the next page of the tour; after the last one, close it."),
    means="next",
    footer=True,
    palette=False,
    label=lambda dialog: N_("To the lessons") if dialog.is_last else N_("Next page"),
)
def next_page(dialog: TourScreen) -> None:
    dialog.turn(1)


@action(
    "tour.back",
    "N",
    N_("Previous page"),
    N_("Show the page before."),
    means="previous",
    footer=True,
    palette=False,
    when=lambda dialog: True if dialog.page else None,
)
def previous_page(dialog: TourScreen) -> None:
    dialog.turn(-1)


@action(
    "tour.leave",
    "escape",
    N_("Leave the tour"),
    N_("Close the tour; it is not shown again by itself."),
    footer=True,
    palette=False,
)
def leave_tour(dialog: TourScreen) -> None:
    dialog.dismiss(None)


class TourScreen(Dialog[None]):
    """Shows the pages."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(next_page, previous_page, leave_tour)
    DEFAULT_CSS = "TourScreen { #dialog { height: 22; } #dialog-scroll { height: 1fr; } }"

    def __init__(self) -> None:
        super().__init__()
        self.page: int = 0
        """From 0."""

    @property
    def is_last(self) -> bool:
        """Whether no page follows."""
        return self.page == len(PAGES) - 1

    def turn(self, by: int) -> None:
        """Show another page; after the last one, close the tour."""
        if by > 0 and self.is_last:
            self.dismiss(None)
            return
        self.page = max(0, self.page + by)
        self.redraw()
        self.refresh_bindings()

    def title_words(self) -> str:
        """Return the title of the page, and which one it is."""
        return f"{_(PAGES[self.page].title)} · {self.page + 1}/{len(PAGES)}"

    def words(self) -> Content:
        """Return the sentences, then the keys."""
        page = PAGES[self.page]
        lines = [Content(f"{_(sentence)}\n") for sentence in page.sentences]
        keys = [self.deck.keys_of(action)[0] for action, _words in page.keys]
        width = max(map(cell_len, keys), default=0)
        lines += [
            Content.assemble((f"  {key:>{width}}", "bold $accent"), f"  {_(words)}")
            for key, (_action, words) in zip(keys, page.keys, strict=True)
        ]
        return Content("\n").join(lines)
