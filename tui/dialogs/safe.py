"""What is shown in place of a screen that cannot be drawn: what runs, and how to stop it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.content import Content
from textual.screen import Screen
from textual.widget import Widget

from text.i18n import _
from text.plain import plain
from tui.frame import title
from tui.frame.actions.app import EmergencyRelease, EmergencyStop, Quit
from tui.frame.host import Host, host_of

if TYPE_CHECKING:
    from textual.app import ComposeResult


LOOK_S = 0.5
"""How often what it says is looked at again."""


class Plainly(Widget):
    """A few lines of text, and nothing that hangs on what others send."""

    DEFAULT_CSS = "Plainly { width: 1fr; height: 1fr; padding: 1 2; }"

    def on_mount(self) -> None:
        """Stay true."""
        self.set_interval(LOOK_S, self.refresh)

    def render(self) -> Content:
        """Draw them."""
        deck = host_of(self)
        return Content("\n".join(plain(line, 400) for line in safe_lines(deck)))


class SafeScreen(Screen[None]):
    """The keys of the app work here: stop, release, leave, and every other screen."""

    def compose(self) -> ComposeResult:
        """The lines alone."""
        yield Plainly()


def safe_lines(deck: Host) -> list[str]:
    """Return what is to be known: that a screen failed, what runs, and the keys."""
    session = deck.feed.session
    runs = "" if session is None else session.name
    states = title.states(deck)
    keys = [
        _("{keys}: {title}").format(keys=" ".join(deck.keys_of(action)), title=_(action.title))
        for action in (EmergencyStop, EmergencyRelease, Quit)
    ]
    tabs = "   ".join(text for text, _action, _front in title.tabs(deck, ""))
    return [
        _("That screen cannot be drawn. The nodes go on, and so does the emergency stop."),
        "",
        "  ".join(filter(None, (runs, states[0] if states else ""))),
        "",
        *keys,
        "",
        _("Another screen, or the same one again: {tabs}").format(tabs=tabs),
        _("The log says what failed."),
    ]
