"""Every key of the screen in front, and what that screen shows."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, ClassVar

from textual.screen import ModalScreen

from text.i18n import N_, _
from tui.actions import Acting, Action, Announce, bindings, bound
from tui.frame.actions.replay import REPLAY_ACTIONS
from tui.frame.host import host_of
from tui.frame.key_bar import KeyBar
from tui.frame.screen import DeckScreen
from tui.frame.title_bar import TitleBar
from tui.help.page import Page, PageEntry

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.binding import BindingType
    from textual.screen import Screen

    from tui.session.messages import LanguageChanged

action: Announce[HelpScreen] = Announce()


@action(
    "help.close",
    "escape,f1,enter",
    N_("Close"),
    N_("Go back to the screen."),
    means="help",
    footer=True,
    palette=False,
)
def close_help(dialog: HelpScreen) -> None:
    dialog.dismiss()


class HelpScreen(ModalScreen[None], Acting):
    """A page generated from the actions, so that it is never wrong about a key."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(close_help)
    DEFAULT_CSS = """
    HelpScreen {
        background: $background;
        Page { padding: 0 2; }
    }
    """

    def __init__(self, explained: Screen[Any]) -> None:
        super().__init__()
        self._explained = explained

    def compose(self) -> ComposeResult:
        """The page between the title and the keys."""
        yield TitleBar()
        yield Page()
        yield KeyBar()

    def on_mount(self) -> None:
        self.redraw()
        self.query_one(Page).focus()

    def on_language_changed(self, message: LanguageChanged) -> None:
        """Show the page in the new language."""
        del message
        self.redraw()

    def redraw(self) -> None:
        """Show the page in the current language."""
        self.query_one(TitleBar).show((), (_("Help"),))
        self.query_one(Page).show(list(self._entries()))

    def _entries(self) -> Iterable[PageEntry]:
        screen = self._explained
        if isinstance(screen, DeckScreen) and screen.about:
            yield PageEntry()
            yield PageEntry(_(screen.about))
        yield from self._section(_("Keys of this screen"), list(bound(screen)))
        if isinstance(screen, DeckScreen):
            for heading, actions in screen.more_keys():
                yield from self._section(heading, list(actions))
        yield from self._section(_("Keys of every screen"), self._everywhere())
        yield PageEntry()
        yield PageEntry(
            _(
                "Tab moves between panels; the mouse clicks, scrolls and selects. In a text field "
                "letters, digits and space are typed: use Ctrl and the function keys there."
            )
        )

    def _everywhere(self) -> list[Action[Any]]:
        """Return the app's actions; those for recordings only in a replay."""
        replayed = host_of(self).feed.replay is not None
        actions = list(bound(self.app))
        return [each for each in actions if replayed or each not in REPLAY_ACTIONS]

    def _section(self, heading: str, actions: list[Action[Any]]) -> Iterable[PageEntry]:
        if actions:
            yield PageEntry(name=heading)
        app = host_of(self)
        for each in actions:
            yield PageEntry(_(each.tooltip), _(each.title), "  ".join(app.keys_of(each)))
