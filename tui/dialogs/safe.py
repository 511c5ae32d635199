"""Shown in place of a screen that cannot be drawn: what is running, and how to stop it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.content import Content
from textual.screen import Screen
from textual.widget import Widget

from text.i18n import _
from text.plain import plain
from tui.frame import title
from tui.frame.actions.app import emergency_release, emergency_stop, leave
from tui.frame.host import Host, host_of

if TYPE_CHECKING:
    from textual.app import ComposeResult


LOOK_S = 0.5
"""How often the text is updated."""


class Plainly(Widget):
    """A few lines of text that do not depend on anything received from others."""

    DEFAULT_CSS = "Plainly { width: 1fr; height: 1fr; padding: 1 2; }"

    def on_mount(self) -> None:
        """Keep the text up to date."""
        self.set_interval(LOOK_S, self.refresh)

    def render(self) -> Content:
        deck = host_of(self)
        return Content("\n".join(plain(line, 400) for line in safe_lines(deck)))


class SafeScreen(Screen[None]):
    """Keeps the keys of the app working: stop, release, leave, and every other screen."""

    def compose(self) -> ComposeResult:
        yield Plainly()


def safe_lines(deck: Host) -> list[str]:
    """Return the lines: that a screen failed, what is running, and the keys."""
    session = deck.feed.session
    runs = "" if session is None else session.name
    _look, alarms = title.alarm(deck)
    keys = [
        _("{keys}: {title}").format(keys=" ".join(deck.keys_of(action)), title=_(action.title))
        for action in (emergency_stop, emergency_release, leave)
    ]
    tabs = "   ".join(text for text, _action, _front in title.tabs(deck, ""))
    return [
        _("That screen cannot be drawn. The nodes and the emergency stop keep working."),
        "",
        "  ".join(filter(None, (runs, *(alarms or title.states(deck))[:1]))),
        "",
        *keys,
        "",
        _("Another screen, or the same one again: {tabs}").format(tabs=tabs),
        _("The log says what failed."),
    ]
