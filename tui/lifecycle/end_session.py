"""Asks before stopping a session that was started elsewhere: whose it is, and what will stop."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.content import Content

from text.i18n import N_, _, ngettext
from text.plain import plain
from tui.actions import Announce, bindings
from tui.dialogs.dialog import Dialog
from tui.session.words import started_words

if TYPE_CHECKING:
    from textual.binding import BindingType

    from launcher.status import SessionInfo

action: Announce[EndSessionScreen] = Announce()


@action(
    "end_session.end",
    "enter",
    N_("End it"),
    N_("Stop all of its nodes, dependants first, and the session."),
    footer=True,
    palette=False,
)
def end_it(dialog: EndSessionScreen) -> None:
    dialog.dismiss(True)


@action(
    "end_session.leave", "escape", N_("Let it run"), N_("Back to the session as it is."), footer=True, palette=False
)
def leave_it(dialog: EndSessionScreen) -> None:
    dialog.dismiss(False)


class EndSessionScreen(Dialog[bool]):
    """Asks whether it is to be ended."""

    BINDINGS: ClassVar[list[BindingType]] = bindings(end_it, leave_it)

    def __init__(self, session: SessionInfo) -> None:
        super().__init__()
        self._session = session

    def title_words(self) -> str:
        return _("End what was started elsewhere?")

    def words(self) -> Content:
        """Say whose it is, how long it has been running, and what stopping it does."""
        session, count = self._session, len(self.deck.feed.nodes)
        ends = ngettext(
            "Its {n} node will be stopped. Every screen that shows it will say that you ended it.",
            "Its {n} nodes will be stopped. Every screen that shows it will say that you ended it.",
            count,
        )
        lines = [
            Content.styled(plain(session.name), "bold"),
            Content(_("domain {domain}").format(domain=session.domain)),
            Content(started_words(session)),
            Content(""),
            Content(ends.format(n=count)),
        ]
        return Content("\n").join(lines)
