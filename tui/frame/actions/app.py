"""The actions of the app, available on every screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from text.i18n import N_, _
from tui.actions.action import Action, Announce, actions_of
from tui.screens import SCREENS

if TYPE_CHECKING:
    from tui.frame.host import Host

action: Announce[Host] = Announce()


def _has_session(host: Host) -> bool:
    """Only while a session is shown, even one that has ended."""
    return host.feed.opened


@action(
    "emergency.stop",
    "space,ctrl+x",
    N_("STOP"),
    N_("Emergency stop: hold the wheels at once, until it is released."),
    footer=True,
    priority=True,
    when=lambda host: host.feed.link is not None or bool(host.sessions.opening),
    shown=lambda host: host.feed.replay is None,
)
def emergency_stop(host: Host) -> None:
    if host.feed.replay is None:
        host.emergency.engage()
    else:
        host.notify(_("This is a recording: there is nothing to stop."), markup=False)


def _may_release(host: Host) -> bool:
    """Whenever there is a robot: pressed in vain, it says so."""
    is_there = host.feed.link is not None or host.emergency.state.waits
    return is_there and host.feed.replay is None


@action(
    "emergency.release",
    "ctrl+r",
    N_("Release"),
    N_("Release the emergency stop: nodes may move the robot again."),
    footer=True,
    priority=True,
    when=lambda host: _may_release(host) and host.emergency.state.engaged,
    pressable=_may_release,
    shown=lambda host: _may_release(host) and host.emergency.state.engaged,
)
def emergency_release(host: Host) -> None:
    if host.emergency.state.engaged:
        host.emergency.release()
    else:
        words = _("Nothing is released: this screen knows of no emergency stop.")
        host.notify(words, markup=False)


@action(
    "app.help",
    "f1,question_mark",
    N_("Help"),
    N_("Every key of this screen, and what it shows."),
    means="help",
    footer=True,
)
def show_help(host: Host) -> None:
    host.show_help()


def _shows(name: str) -> Action[Host]:
    entry = SCREENS[name]
    can = _has_session if entry.is_there else lambda _host: False

    @action(f"screen.{name}", entry.key, entry.title, entry.about, when=can)
    async def show(host: Host) -> None:
        await host.show_screen(name)

    return show


SHOW = {name: _shows(name) for name, entry in SCREENS.items() if entry.key}
"""The action that brings each screen to the front."""


@action(
    "app.palette",
    "ctrl+p",
    N_("Palette"),
    N_("Find anything that can be done by its name."),
    footer=True,
    priority=True,
    palette=False,
)
def show_palette(host: Host) -> None:
    host.show_palette()


@action("app.tour", "shift+f1", N_("Tour"), N_("What Deck is for and which keys matter, in five pages."))
def show_tour(host: Host) -> None:
    host.show_tour()


@action(
    "session.close",
    "f8",
    N_("Lessons"),
    N_("Back to the list of lessons; nodes that this screen has started are stopped."),
    when=_has_session,
)
def close_session(host: Host) -> None:
    host.sessions.close()


@action(
    "session.end",
    "shift+f8",
    N_("End the session"),
    N_("End a session that was started elsewhere, after saying whose it is and asking."),
    when=lambda host: host.feed.of_others,
)
def end_session(host: Host) -> None:
    host.sessions.end_of_others()


@action("app.language", "f9", N_("English / Русский"), N_("Switch the language of the screen."), priority=True)
def switch_language(host: Host) -> None:
    host.switch_language()


@action("app.theme", "f10", N_("Theme"), N_("Dark, light, high contrast."), priority=True)
def switch_theme(host: Host) -> None:
    host.next_theme()


@action(
    "app.redraw",
    "ctrl+l",
    N_("Redraw"),
    N_("Redraw everything, if something else has written to the terminal."),
    priority=True,
)
def redraw(host: Host) -> None:
    host.redraw()


@action(
    "app.quit",
    "q,ctrl+q",
    N_("Quit"),
    N_("Leave; nodes that this screen has started are stopped, others go on."),
    means="leave",
    footer=True,
    priority=True,
    label=lambda host: N_("Detach") if host.feed.of_others else N_("Quit"),
)
def leave(host: Host) -> None:
    host.sessions.leave()


APP_ACTIONS = actions_of(__name__)
TABS = [show for name, show in SHOW.items() if name != "wall" and SCREENS[name].is_there]
"""In the order in which the top line names them."""
