"""Asks before a session is ended that was started elsewhere: whose it is, and what goes with it."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, ClassVar

from textual.content import Content

from launcher.processes.owner import who_words
from text.i18n import N_, _, ngettext, said
from text.plain import plain
from tui.actions import Action, bindings
from tui.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from textual.binding import BindingType

    from launcher.status import SessionInfo


class EndIt(Action["EndSessionScreen"]):
    """Stop all of its nodes."""

    id = "end_session.end"
    key = "enter"
    title = N_("End it")
    tooltip = N_("Stop all of its nodes, dependants first, and the session.")
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: EndSessionScreen) -> None:
        """Answer yes."""
        target.dismiss(True)


class LeaveIt(Action["EndSessionScreen"]):
    """Let it go on."""

    id = "end_session.leave"
    key = "escape"
    title = N_("Let it run")
    tooltip = N_("Back to the session as it is.")
    footer = True
    palette = False

    @classmethod
    async def run(cls, target: EndSessionScreen) -> None:
        """Answer no."""
        target.dismiss(False)


class EndSessionScreen(Dialog[bool]):
    """Asks whether it is to be ended."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(EndIt, LeaveIt)

    def __init__(self, session: SessionInfo) -> None:
        """Ask about `session`."""
        super().__init__()
        self._session = session

    def title_words(self) -> str:
        """Name the question."""
        return _("End what was started elsewhere?")

    def words(self) -> Content:
        """Say whose it is, since when it runs, and what ending it does."""
        session, count = self._session, len(self.deck.feed.nodes)
        ends = ngettext(
            "Its {n} node will be stopped. Every screen that shows it will be told that you "
            "ended it.",
            "Its {n} nodes will be stopped. Every screen that shows it will be told that you "
            "ended it.",
            count,
        )
        lines = [
            Content.styled(plain(session.name), "bold"),
            Content(_("domain {domain}").format(domain=session.domain)),
            Content(started(session)),
            Content(""),
            Content(ends.format(n=count)),
        ]
        return Content("\n").join(lines)


def started(session: SessionInfo) -> str:
    """Say who has started a session, where and when."""
    who = plain(said(who_words(session.started_by)), 200)
    since = time.strftime("%H:%M", time.localtime(session.since_s))
    if session.foreground:
        return _("On another screen: {who}, since {since}").format(who=who, since=since)
    return _("In the background, started by {who} at {since}").format(who=who, since=since)
