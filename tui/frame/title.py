"""The content of the top line: the screens, and what is running, held or stopped."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from text.i18n import _, localized, ngettext, pick
from text.plain import plain
from tui.clock import time_of_day
from tui.emergency.gate import rare_words
from tui.emergency.state import held_reason
from tui.emergency.words import stop_words
from tui.frame.actions.app import TABS, emergency_release
from tui.session.watching import robot_nodes
from tui.session.words import hardware_words

if TYPE_CHECKING:
    from launcher.status import SessionInfo
    from tui.emergency.state import Emergency
    from tui.frame.host import Host
    from tui.frame.title_bar import TitleBar


def show(bar: TitleBar, app: Host, front: str) -> None:
    """Show everything on a bar; `front` is the screen in front."""
    look, alarms = alarm(app)
    bar.show(tabs(app, front), states(app), alarms, look)


def tabs(app: Host, front: str) -> Sequence[tuple[str, str, bool]]:
    """Return (text, action, in front) for every screen of the session."""
    return [
        (f"{app.keys_of(tab)[0]} {_(tab.title)}", f"app.act({tab.id!r})", tab.id == f"screen.{front}") for tab in TABS
    ]


def starting(app: Host) -> bool:
    """Return whether a node is not at work yet."""
    return any(node.state.coming for node in app.feed.nodes.values())


def states(app: Host) -> Sequence[str]:
    """Return what is running or recorded, from long to short."""
    session = app.feed.session
    if session is None:
        if app.feed.ended:
            return (localized(app.feed.ended), _("ended"))
        opening = app.sessions.opening
        return (_("opening {name}…").format(name=plain(opening)),) if opening else ()
    return _replayed(session) if app.feed.replay is not None else _recorded(app, session)


def alarm(app: Host) -> tuple[str, Sequence[str]]:
    """Return how an alarm looks, and its texts from long to short; none if nothing is amiss.

    `stop` while stopped, `danger` while somebody drives past the gate, `alarm` while the gate
    holds, what is shown of the graph is old, or the session has lost its guardian.
    """
    return next(_alarms(app), ("", ()))


def _alarms(app: Host) -> Iterator[tuple[str, Sequence[str]]]:
    """Yield what is amiss, the worst first."""
    emergency, update, link = app.emergency.state, app.feed.update, app.feed.link
    if emergency.engaged if app.feed.session else emergency.waits:
        yield "stop", stop_words(emergency, app.keys_of(emergency_release)[0])
    if update is not None and update.old_since_s is not None:
        # Whatever else there is to say was true then.
        words = _("⚠ No word of the ROS graph since {time}: what is shown is from then")
        yield "alarm", (words.format(time=time_of_day(update.old_since_s)),)
    if app.bypass.now:
        yield "danger", app.bypass.words()
    if emergency.blocked:
        yield "alarm", _held(emergency)
    if link is not None and link.unguarded:
        yield "alarm", (_("⚠ The guardian process is dead: start the session anew"),)


def domain_words(session: SessionInfo) -> str:
    """Return the ROS domain, which is in the title at every size."""
    return _("domain {domain}").format(domain=session.domain)


def _held(state: Emergency) -> Sequence[str]:
    """Return why the gate holds the wheels, or what it refused although it does not hold them."""
    reason = held_reason(state)
    whole = f"⚠ {reason[:1].upper()}{reason[1:]}"
    rare = "" if state.gate is None else rare_words(state.gate)
    return (whole, f"⚠ {rare}") if rare else (whole,)


def _watched(app: Host, session: SessionInfo) -> Sequence[str]:
    """Return the domain, and the number of nodes that others have started in it."""
    update = app.feed.update
    count = 0 if update is None else len(robot_nodes(update))
    found = ngettext("{n} node", "{n} nodes", count).format(n=count)
    domain = domain_words(session)
    watching = _("watching {domain}").format(domain=domain)
    return (f"{watching} · {found}", watching, domain)


def _replayed(session: SessionInfo) -> Sequence[str]:
    name = plain(session.name)
    return (_("recording {name}").format(name=name), name)


def _recorded(app: Host, session: SessionInfo) -> Sequence[str]:
    """Return what is being recorded, then what is running."""
    recorded = app.recording.words
    if not recorded:
        return _running(app, session)
    everything = (f"{words} · {running}" for running in _running(app, session) for words in recorded[:2])
    short = (f"{words} · {domain_words(session)}" for words in recorded)
    return (*everything, *short, recorded[-1])


def _running(app: Host, session: SessionInfo) -> Sequence[str]:
    if app.feed.watching:
        return _watched(app, session)
    nodes = app.feed.nodes.values()
    well = sum(node.serves and not node.ails for node in nodes)
    sign = "◔" if starting(app) else "●" if well == len(nodes) else "○"
    count = f"{sign} {well}/{len(nodes)}"
    name, hardware = plain(session.name), hardware_words(session.hardware)
    title = f"{plain(session.lesson)} {pick(session.title)}".strip() or name
    domain = domain_words(session)
    names = (f"{title} · {hardware}", title, name)
    return (*(f"{words} · {domain} · {count}" for words in names), f"{domain} · {count}", domain)
