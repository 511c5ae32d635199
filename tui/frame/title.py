"""The content of the top line: the screens, and what is running, held or stopped."""

from __future__ import annotations

from collections.abc import Sequence
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
    bar.show(tabs(app, front), states(app), look(app), aside(app))


def tabs(app: Host, front: str) -> Sequence[tuple[str, str, bool]]:
    """Return (text, action, in front) for every screen of the session."""
    return [
        (f"{app.keys_of(tab)[0]} {_(tab.title)}", f"app.act({tab.id!r})", tab.id == f"screen.{front}") for tab in TABS
    ]


def look(app: Host) -> str:
    """Return the style of the title.

    `stop` while stopped, `danger` while somebody drives past the gate, `alarm` while the gate
    holds, what is shown of the graph is old, or the session has lost its guardian.
    """
    if app.feed.link is None:
        return "stop" if app.emergency.state.waits else "state"
    if app.emergency.state.engaged:
        return "stop"
    if _old_since_s(app) is not None:
        return "alarm"
    if app.bypass.now:
        return "danger"
    return "alarm" if app.emergency.state.blocked or _is_unguarded(app) else "state"


def starting(app: Host) -> bool:
    """Return whether a node is not at work yet."""
    return any(node.state.coming for node in app.feed.nodes.values())


def states(app: Host) -> Sequence[str]:
    """Return the texts of the state, from long to short; the first that fits is shown."""
    session = app.feed.session
    if session is None:
        if app.emergency.state.waits:
            return _stopped(app)
        if app.feed.ended:
            return (localized(app.feed.ended), _("ended"))
        opening = app.sessions.opening
        return (_("opening {name}…").format(name=plain(opening)),) if opening else ()
    alarm = _alarm(app)
    if alarm:
        return _where(session, alarm)
    return _replayed(session) if app.feed.replay is not None else _recorded(app, session)


def _alarm(app: Host) -> Sequence[str]:
    """Return the texts of what `look` is about; none if nothing is amiss."""
    if app.emergency.state.engaged:
        return _stopped(app)
    old_since_s = _old_since_s(app)
    if old_since_s is not None:
        # Whatever else there is to say was true then.
        return _old(old_since_s)
    if app.bypass.now:
        return app.bypass.words()
    if app.emergency.state.blocked:
        return _held(app.emergency.state)
    return _unguarded() if _is_unguarded(app) else ()


def _stopped(app: Host) -> Sequence[str]:
    return stop_words(app.emergency.state, app.keys_of(emergency_release)[0])


def aside(app: Host) -> str:
    """Return what to show beside an alarm if no tab loses its name for it: the recording."""
    # Only its size: a longer text would appear only on wide terminals.
    return "".join(app.recording.words[-1:]) if look(app) != "state" else ""


def _where(session: SessionInfo, alarm: Sequence[str]) -> Sequence[str]:
    """Return the texts of an alarm, and the first one also with the domain if there is room."""
    return (f"{alarm[0]} · {domain_words(session)}", *alarm)


def domain_words(session: SessionInfo) -> str:
    """Return the ROS domain, which is in the title at every size."""
    return _("domain {domain}").format(domain=session.domain)


def _old_since_s(app: Host) -> float | None:
    update = app.feed.update
    return None if update is None else update.old_since_s


def _old(since_s: float) -> Sequence[str]:
    """Return that nothing is heard of the graph, and since when."""
    time = time_of_day(since_s)
    return (
        _("⚠ No word of the ROS graph since {time}: what is shown is from then").format(time=time),
        _("⚠ graph of {time}").format(time=time),
    )


def _is_unguarded(app: Host) -> bool:
    return app.feed.link is not None and app.feed.link.unguarded


def _unguarded() -> Sequence[str]:
    """Return that the guardian is gone, and what brings it back."""
    return (_("⚠ The guardian process is dead: start the session anew"), _("⚠ guardian dead"))


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
