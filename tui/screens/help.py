"""Every key of the screen in front, and what that screen shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from textual.containers import Horizontal
from textual.content import Content
from textual.widgets import Static

from tui.actions import Action, bindings, bound
from tui.i18n import N_, _
from tui.screens.base import DeckScreen
from tui.screens.dialog import Dialog

if TYPE_CHECKING:
    from textual.app import ComposeResult
    from textual.binding import BindingType
    from textual.screen import Screen

    from tui.messages import LanguageChanged


class CloseHelp(Action["HelpScreen"]):
    """Back to the screen."""

    id = "help.close"
    key = "escape,f1,enter"
    title = N_("Close")
    tooltip = N_("Go back to the screen.")
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: HelpScreen) -> None:
        """Close it."""
        target.dismiss()


class HelpScreen(Dialog[None]):
    """A page made of the actions themselves, so that it cannot be wrong about a key."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(CloseHelp)
    DEFAULT_CSS = """
    HelpScreen {
        #dialog { width: 110; }
        .help-text { height: auto; padding: 1 1 0 1; }
        .help-heading { height: auto; padding: 1 1 0 1; color: $text-accent; text-style: bold; }
        .help-line { height: auto; padding: 0 1; }
        .help-keys { width: 14; height: auto; text-style: bold; }
        .help-what { width: 1fr; height: auto; }
    }
    """

    def __init__(self, explained: Screen[Any]) -> None:
        """Explain this screen."""
        super().__init__()
        self._explained = explained

    async def on_language_changed(self, message: LanguageChanged) -> None:  # type: ignore[override]
        """Write the page anew."""
        await self.recompose()
        super().on_language_changed(message)

    def title_words(self) -> str:
        """Name the page."""
        return _("Help")

    def compose_text(self) -> ComposeResult:
        """Say what the screen shows, its keys, and the keys of all screens."""
        screen = self._explained
        if isinstance(screen, DeckScreen) and screen.about:
            yield Static(_(screen.about), classes="help-text", markup=False)
        yield from self._section(_("Keys of this screen"), list(bound(screen)))
        yield from self._section(_("Keys of every screen"), list(bound(self.app)))
        palette = self.deck.key_text(self.app.COMMAND_PALETTE_BINDING)
        yield _line(palette, _("Palette"), _("Find anything that can be done by its name."))
        words = _(
            "Tab moves between panels; the mouse clicks, scrolls and selects. In a text field "
            "letters, digits and space are typed: use Ctrl and the function keys there."
        )
        yield Static(words, classes="help-text", markup=False)

    def _section(self, heading: str, actions: list[type[Action[Any]]]) -> ComposeResult:
        if actions:
            yield Static(heading, classes="help-heading", markup=False)
        for action in actions:
            keys = "  ".join(self.deck.keys_of(action))
            yield _line(keys, _(action.title), _(action.tooltip))


def _line(keys: str, title: str, tooltip: str) -> Horizontal:
    what = Content.assemble((title, "bold"), " · ", (tooltip, "$text-muted"))
    return Horizontal(
        Static(keys, classes="help-keys", markup=False),
        Static(what, classes="help-what", markup=False),
        classes="help-line",
    )
